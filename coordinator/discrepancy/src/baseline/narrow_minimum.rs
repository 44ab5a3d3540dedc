//! Search for another narrow minimum (valley) of the misfit along an unknown, from a fit with a large
//! residual.
//!
//! An excitation rings the modes of a model, some at many times the frequency of the period. An effect that
//! shifts time slightly changes their phase considerably: the narrow minimum of the model without that effect
//! is elsewhere, and a fit settles on the plateau where damping or stiffness suppresses the modes. The
//! unknown is therefore scanned again, as the case specifies, with the effect switched on, and fits from the
//! best points of the scan compete.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::LeastSquaresSettings;
use search::strategy::levenberg::SpacingRule;
use search::strategy::staged::{RACE, coarse_scan};

/// Maximum `chi^2` of a fit in another narrow minimum, as a share of that of the first fit, for which it
/// counts as better.
pub(crate) const BETTER: f64 = 0.9;

/// Returns a clearly better fit of the same model in another narrow minimum, if there is one; `None` where no
/// unknown has a narrow minimum.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn scan<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
) -> Result<Option<Fit>, L::Error> {
    let space = &fit.model.space;
    let Some(scan) = coarse_scan(space) else {
        return Ok(None);
    };
    let (genes, rest) = fit.x().split_at(space.dimension());
    let station = |genes: Vec<f64>| {
        let inside = genes.into_iter().zip(space.axes());
        let inside = inside.map(|(x, axis)| axis.interval().clamp(x));
        Point {
            model: fit.model.clone(),
            x: inside.chain(rest.iter().copied()).collect(),
        }
    };
    let stations = scan.points_around(space, genes).into_iter();
    let stations: Vec<Point> = stations.map(station).collect();
    let curves = experiments.curves(&stations).await?;
    let left = |curves| experiments.on.residual(&curves).norm_squared();
    let seen = stations.into_iter().zip(curves);
    let mut seen: Vec<(f64, Point)> = seen
        .filter_map(|(point, curves)| Some((left(curves?), point)))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = seen.into_iter().map(|(_, point)| point);
    let starts = SpacingRule::new(space, RACE.apart).first(RACE.starts, best, |point| &point.x);
    race(experiments, fit, starts).await
}

/// Returns the fit from the best of several starts if it is clearly better than a given fit of the same
/// model. All starts are fitted for a few iterations, the worse half is dropped, and so on until the best
/// remains.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn race<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    mut starts: Vec<Point>,
) -> Result<Option<Fit>, L::Error> {
    let best = loop {
        let fits = experiments
            .fits(
                starts,
                LeastSquaresSettings::short(RACE.elimination_interval),
            )
            .await?;
        let mut fits: Vec<Fit> = fits.into_iter().flatten().collect();
        fits.sort_by(|a, b| a.chi_squared().total_cmp(&b.chi_squared()));
        if fits.len() <= RACE.keep {
            break fits.into_iter().next();
        }
        fits.truncate(fits.len().div_ceil(2).max(RACE.keep));
        starts = fits.iter().map(Fit::point).collect();
    };
    let better = |best: &Fit| best.chi_squared() < BETTER * fit.chi_squared();
    let Some(best) = best.filter(better) else {
        return Ok(None);
    };
    let further = experiments
        .fit(best.point(), LeastSquaresSettings::default())
        .await?;
    Ok(further.or(Some(best)))
}
