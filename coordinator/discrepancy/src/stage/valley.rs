//! Another way into the valley of the rope's stiffness, from a fit that leaves much.
//!
//! The load excites two modes of the rope, some sixty and eighty times a turn. An effect that moves the
//! clock of the crank by a tenth of a degree moves their phase by ten degrees: without that effect in
//! the model the valley is not where it is with it, and a fit settles on the plateau on which damping
//! or stiffness hides the modes. So the stiffness is scanned again with the effect switched on, at the
//! damping that ropes have, and the fit goes on from the best stations.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
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
/// A fit is another one if it leaves less than this share.
const BETTER: f64 = 0.9;

/// A clearly better fit of the same model in another valley, if there is one; its experiments count
/// for a stage.
///
/// # Errors
/// Of the laboratory.
pub async fn enter<L: Laboratory>(
    lab: &mut L,
    (bench, stage): (&Bench, Stage),
    fit: &Fit,
) -> Result<Option<Fit>, L::Error> {
    let stations = stations(&fit.model, fit.x());
    let points: Vec<(&Model, &[f64])> = stations
        .iter()
        .map(|x| (&fit.model, x.as_slice()))
        .collect();
    let curves = bench.curves(lab, stage, &points).await?;
    let mut seen: Vec<(f64, &Vec<f64>)> = stations
        .iter()
        .zip(curves)
        .filter_map(|(x, curves)| Some((bench.residual(&curves?).norm_squared(), x)))
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(stiffness) = fit.model.space.position(Coefficient::Kb1) else {
        return Ok(None);
    };
    let mut starts: Vec<(Model, Vec<f64>)> = Vec::new();
    for (_, x) in seen {
        let near = |(_, other): &(Model, Vec<f64>)| (other[stiffness] - x[stiffness]).abs() < APART;
        if starts.len() < STARTS && !starts.iter().any(near) {
            starts.push((fit.model.clone(), x.clone()));
        }
    }
    follow(lab, (bench, stage), fit, starts).await
}

/// The best of several starts, where it becomes clearly better than a fit of the same model: a few steps of
/// each, then on with the best.
///
/// # Errors
/// Of the laboratory.
pub async fn follow<L: Laboratory>(
    lab: &mut L,
    (bench, stage): (&Bench, Stage),
    fit: &Fit,
    starts: Vec<(Model, Vec<f64>)>,
) -> Result<Option<Fit>, L::Error> {
    let short = Settings {
        iterations: 3,
        ..Settings::default()
    };
    let fits = bench.fit(lab, stage, starts, short).await?;
    let best = fits
        .into_iter()
        .flatten()
        .min_by(|a, b| a.chi_squared().total_cmp(&b.chi_squared()))
        .filter(|best| best.chi_squared() < BETTER * fit.chi_squared());
    let Some(best) = best else {
        return Ok(None);
    };
    let start = vec![(best.model.clone(), best.x().to_vec())];
    let fits = bench.fit(lab, stage, start, Settings::default()).await?;
    Ok(fits.into_iter().next().flatten().or(Some(best)))
}

/// Lines along the stiffness through a point; none where the space lacks it.
fn stations(model: &Model, x: &[f64]) -> Vec<Vec<f64>> {
    let space = &model.space;
    let Some(stiffness) = space.position(Coefficient::Kb1) else {
        return Vec::new();
    };
    let (damping, contact) = (
        space.position(Coefficient::Cb1),
        space.position(Coefficient::Kc),
    );
    let mut bases = vec![x.to_vec()];
    if let Some(contact) = contact {
        for shift in CONTACTS {
            let mut other = x.to_vec();
            other[contact] = space.axes()[contact].trust.clamp(x[contact] + shift);
            if (other[contact] - x[contact]) * shift.signum() > 0.3 {
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
    let grid = (0..=count).map(|k| FROM + STEP * k as f64);
    let grid: Vec<f64> = grid
        .filter(|at| (interval.from..=interval.to).contains(at))
        .collect();
    let mut stations = Vec::with_capacity(2 * bases.len() * grid.len());
    for base in &bases {
        for time in DAMPING_TIMES {
            for at in &grid {
                let mut station = base.clone();
                station[stiffness] = *at;
                if let Some(damping) = damping {
                    let own = &space.axes()[damping];
                    let wanted = own.coordinate(time * axis.value(*at));
                    station[damping] = own.interval().clamp(wanted);
                }
                stations.push(station);
            }
        }
    }
    stations
}
