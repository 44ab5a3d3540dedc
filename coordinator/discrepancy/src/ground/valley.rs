//! Another way into a narrow valley of an unknown, from a fit that leaves much.
//!
//! An excitation rings a model's modes, some of them many times a period. An effect that moves a clock by
//! a little moves their phase by a lot: without that effect in the model the valley is not where it is
//! with it, and a fit settles on the plateau on which damping or stiffness hides the modes. So the
//! unknown is scanned again with the effect switched on, as the case says, and the fit goes on from the
//! best stations.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, closest};
use crate::model::unknowns::Point;
use protocol::case::Valley;
use search::least_squares::Settings;

/// Stations from which a fit goes on, and how far apart they are (coordinate).
const STARTS: usize = 3;
const APART: f64 = 0.05;
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
    let axes = fit.model.space.axes().iter().enumerate();
    let mut valleys = axes.filter_map(|(k, axis)| Some((k, axis.unknown.valley.as_ref()?)));
    let Some((scanned, valley)) = valleys.next() else {
        return Ok(None);
    };
    let stations = stations(&fit.point(), scanned, valley);
    let curves = experiments.curves(&stations).await?;
    let left = |curves| experiments.on.residual(&curves).norm_squared();
    let seen = stations.into_iter().zip(curves);
    let mut seen: Vec<(f64, Point)> = seen
        .filter_map(|(point, curves)| Some((left(curves?), point)))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut starts: Vec<Point> = Vec::new();
    for (_, point) in seen {
        let near = |other: &Point| (other.x[scanned] - point.x[scanned]).abs() < APART;
        if starts.len() < STARTS && !starts.iter().any(near) {
            starts.push(point);
        }
    }
    follow(experiments, fit, starts).await
}

/// The best of several starts, where it becomes clearly better than a fit of the same model: a few steps of
/// each, then on with the best.
///
/// # Errors
/// Those of the laboratory.
pub async fn follow<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    starts: Vec<Point>,
) -> Result<Option<Fit>, L::Error> {
    let best = closest(experiments.fits(starts, Settings::short(3)).await?);
    let better = |best: &Fit| best.chi_squared() < BETTER * fit.chi_squared();
    let Some(best) = best.filter(better) else {
        return Ok(None);
    };
    let further = experiments.fit(best.point(), Settings::default()).await?;
    Ok(further.or(Some(best)))
}

/// Lines along the scanned axis through a point, and beside it.
fn stations(from: &Point, scanned: usize, valley: &Valley) -> Vec<Point> {
    let (space, x) = (&from.model.space, &from.x);
    let mut bases = vec![from.clone()];
    for shift in &valley.stand_ins {
        let Some(axis) = space.position(&shift.unknown) else {
            continue;
        };
        let mut other = from.clone();
        other.x[axis] = space.axes()[axis].trust.clamp(x[axis] + shift.by);
        if (other.x[axis] - x[axis]) * shift.by.signum() > 0.3 {
            bases.push(other);
        }
    }
    let axis = &space.axes()[scanned];
    let interval = axis.interval();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive number"
    )]
    let count = ((valley.to - valley.from) / valley.step).round() as usize;
    let station = |k: usize| valley.from + valley.step * k as f64;
    let mut grid: Vec<f64> = (0..=count).map(station).collect();
    grid.retain(|at| (interval.from..=interval.to).contains(at));
    let shared = valley.shares.as_ref();
    let shared = shared.and_then(|shares| Some((space.position(&shares.unknown)?, shares)));
    let shares: Vec<Option<(usize, f64)>> = match shared {
        Some((axis, shares)) => shares.of_scanned.iter().map(|&s| Some((axis, s))).collect(),
        None => vec![None],
    };
    let mut stations = Vec::with_capacity(shares.len() * bases.len() * grid.len());
    for base in &bases {
        for share in &shares {
            for at in &grid {
                let mut station = base.clone();
                station.x[scanned] = *at;
                if let Some((follower, share)) = *share {
                    let own = &space.axes()[follower];
                    let wanted = own.coordinate(share * axis.value(*at));
                    station.x[follower] = own.interval().clamp(wanted);
                }
                stations.push(station);
            }
        }
    }
    stations
}
