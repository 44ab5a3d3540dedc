//! Another way into a narrow valley of an unknown, from a fit that leaves much.
//!
//! An excitation rings a model's modes, some of them many times a period. An effect that moves a clock by
//! a little moves their phase by a lot: without that effect in the model the valley is not where it is
//! with it, and a fit settles on the plateau on which damping or stiffness hides the modes. So the
//! unknown is scanned again with the effect switched on, as the case says, and fits race from the best
//! stations.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::Settings;
use search::strategy::levenberg::Apart;
use search::strategy::quick::{RACE, coarse_scan};

/// A fit lies in another valley if it leaves less than this share of what the first one left.
pub(crate) const BETTER: f64 = 0.9;

/// A clearly better fit of the same model in another valley, if there is one; none where no unknown has a
/// narrow valley.
///
/// # Errors
/// Those of the laboratory.
pub async fn enter<L: Laboratory>(
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
    let starts = Apart::new(space, RACE.apart).first(RACE.starts, best, |point| &point.x);
    follow(experiments, fit, starts).await
}

/// The best of several starts, where it becomes clearly better than a fit of the same model: a race that gives up
/// the worse half after every heat, then on with the best.
///
/// # Errors
/// Those of the laboratory.
pub async fn follow<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    mut starts: Vec<Point>,
) -> Result<Option<Fit>, L::Error> {
    let best = loop {
        let fits = experiments.fits(starts, Settings::short(RACE.heat)).await?;
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
    let further = experiments.fit(best.point(), Settings::default()).await?;
    Ok(further.or(Some(best)))
}
