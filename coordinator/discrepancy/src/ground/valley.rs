//! Another way into the valley of the rope's stiffness, from a fit that leaves much.
//!
//! The load excites two modes of the rope, some sixty and eighty times a turn. An effect that moves the
//! clock of the crank by a tenth of a degree moves their phase by ten degrees: without that effect in
//! the model the valley is not where it is with it, and a fit settles on the plateau on which damping
//! or stiffness hides the modes. So the stiffness is scanned again with the effect switched on, at the
//! damping that ropes have, and the fit goes on from the best stations.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, closest};
use crate::model::unknowns::Point;
use protocol::case::Coefficient;
use search::least_squares::Settings;

/// Damping over stiffness of a joint (s): 1 and 4 % of critical at the modes' 6 Hz, between which wire
/// ropes lie.
const DAMPING_TIMES: [f64; 2] = [6e-4, 2e-3];
/// How much harder and softer the contact is on further sets of lines (decades): a soft one can stand in
/// for a soft rope, and of a very hard one no small change shows.
const CONTACTS: [f64; 2] = [1.5, -1.5];
/// Where the stiffness is scanned, from its recommended value, and in which steps (decades).
const FROM: f64 = -0.3;
const TO: f64 = 1.1;
const STEP: f64 = 0.02;
/// Stations from which a fit goes on, and how far apart they are (decades).
const STARTS: usize = 3;
const APART: f64 = 0.05;
/// A fit lies in another valley if it leaves less than this share of what the first one left.
pub(crate) const BETTER: f64 = 0.9;

/// A clearly better fit of the same model in another valley, if there is one.
///
/// # Errors
/// Those of the laboratory.
pub async fn enter<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
) -> Result<Option<Fit>, L::Error> {
    let stations = stations(&fit.point());
    let curves = experiments.curves(&stations).await?;
    let Some(stiffness) = fit.model.space.position(Coefficient::Kb1) else {
        return Ok(None);
    };
    let left = |curves| experiments.on.residual(&curves).norm_squared();
    let seen = stations.into_iter().zip(curves);
    let mut seen: Vec<(f64, Point)> = seen
        .filter_map(|(point, curves)| Some((left(curves?), point)))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut starts: Vec<Point> = Vec::new();
    for (_, point) in seen {
        let near = |other: &Point| (other.x[stiffness] - point.x[stiffness]).abs() < APART;
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

/// Lines along the stiffness through a point; none where the space lacks it.
fn stations(from: &Point) -> Vec<Point> {
    let (space, x) = (&from.model.space, &from.x);
    let Some(stiffness) = space.position(Coefficient::Kb1) else {
        return Vec::new();
    };
    let damping = space.position(Coefficient::Cb1);
    let contact = space.position(Coefficient::Kc);
    let mut bases = vec![from.clone()];
    if let Some(contact) = contact {
        for shift in CONTACTS {
            let mut other = from.clone();
            other.x[contact] = space.axes()[contact].trust.clamp(x[contact] + shift);
            if (other.x[contact] - x[contact]) * shift.signum() > 0.3 {
                bases.push(other);
            }
        }
    }
    let axis = &space.axes()[stiffness];
    let interval = axis.interval();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive number"
    )]
    let count = ((TO - FROM) / STEP).round() as usize;
    let mut grid: Vec<f64> = (0..=count).map(|k| FROM + STEP * k as f64).collect();
    grid.retain(|at| (interval.from..=interval.to).contains(at));
    let mut stations = Vec::with_capacity(2 * bases.len() * grid.len());
    for base in &bases {
        for time in DAMPING_TIMES {
            for at in &grid {
                let mut station = base.clone();
                station.x[stiffness] = *at;
                if let Some(damping) = damping {
                    let own = &space.axes()[damping];
                    let wanted = own.coordinate(time * axis.value(*at));
                    station.x[damping] = own.interval().clamp(wanted);
                }
                stations.push(station);
            }
        }
    }
    stations
}
