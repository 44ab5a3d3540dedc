//! Refits with one unknown held: steps with the Jacobian of the original fit, at the cost of one or two
//! simulations each, and a new Jacobian only where these steps no longer help.
use super::profile::{NEAR, RISE};
use super::settings::FREE;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use nalgebra::{DMatrix, DVector};
use search::least_squares::{LeastSquaresSettings, Linearized, prior_cost, undamped};

/// Share of the rise that ends a profile side, below which a point is not refitted, because a refit would
/// only lower its cost further.
const LITTLE: f64 = 1.0 - NEAR;
/// Minimum gain of a step, as a share of the rise that ends a profile side; after a smaller gain the Jacobian
/// is computed anew.
const GAIN: f64 = 0.02;
/// Lengths of a Gauss-Newton step that are tried in parallel, as shares of the full step.
const TRIED: [f64; 2] = [1.0, 0.3];
/// Maximum number of steps of a refit with one unknown held. [`JACOBIANS`] is the maximum number of its new
/// Jacobians.
const STEPS: usize = 8;
const JACOBIANS: usize = 2;

/// Inputs of the refits: the original fit, and for each unknown the rise of the cost that ends its profile.
pub(super) struct RefitRequest<'a> {
    pub(super) fit: &'a Fit,
    pub(super) rises: &'a [f64],
}

/// State of a refit with one unknown held.
struct Descent {
    point: Point,
    residual: DVector<f64>,
    cost: f64,
    jacobian: DMatrix<f64>,
    /// Number of Jacobians computed so far for this refit.
    own: usize,
    /// Whether the Jacobian was computed at the current point.
    fresh: bool,
    over: bool,
    /// Rise of the cost that ends the profile of the held unknown.
    rise: f64,
}

impl Descent {
    /// Returns trial points of several lengths along the undamped Gauss-Newton step.
    fn trials(&self) -> Vec<Point> {
        let at = Linearized {
            x: self.point.x.clone(),
            residual: self.residual.clone(),
            jacobian: self.jacobian.clone(),
        };
        let variables = self.point.model.variables(&at.x);
        let Some(step) = undamped(&at, &variables) else {
            return Vec::new();
        };
        let trial = |share: f64| {
            let mut point = self.point.clone();
            for ((x, step), v) in point.x.iter_mut().zip(step.iter()).zip(&variables) {
                *x = (*x + share * step).clamp(v.lower, v.upper);
            }
            point
        };
        TRIED.into_iter().map(trial).collect()
    }
}

/// Refits several profile points, each from the best of its starts; returns cost and variables, `None` where
/// no start completes.
pub(super) async fn refit<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    asked: &RefitRequest<'_>,
    starts: Vec<Vec<Point>>,
) -> Result<Vec<Option<(f64, Vec<f64>)>>, L::Error> {
    let least = asked.fit.search.cost();
    let jacobian = &asked.fit.search.best().jacobian;
    let begun = best_of(experiments, starts).await?;
    let mut all: Vec<Option<Descent>> = begun
        .into_iter()
        .map(|begun| {
            let (cost, residual, point) = begun?;
            let rise = point
                .model
                .fixed_unknown
                .and_then(|k| asked.rises.get(k).copied());
            let rise = rise.unwrap_or(RISE);
            Some(Descent {
                over: cost - least <= LITTLE * rise,
                rise,
                point,
                residual,
                cost,
                jacobian: jacobian.clone(),
                own: 0,
                fresh: false,
            })
        })
        .collect();
    for _ in 0..STEPS {
        let mut active: Vec<&mut Descent> =
            all.iter_mut().flatten().filter(|one| !one.over).collect();
        if active.is_empty() {
            break;
        }
        let trials = active.iter().map(|one| one.trials()).collect();
        let best = best_of(experiments, trials).await?;
        for (one, best) in active.iter_mut().zip(best) {
            let gained = best.as_ref().map_or(0.0, |(cost, ..)| one.cost - cost);
            if let Some((cost, residual, point)) = best.filter(|_| gained > 0.0) {
                one.cost = cost;
                one.residual = residual;
                one.point = point;
            }
            one.over = one.cost - least <= LITTLE * one.rise
                || (gained < GAIN * one.rise && (one.fresh || one.own >= JACOBIANS));
            // what did not help was of another point
            one.fresh = !one.over && gained < GAIN * one.rise;
        }
        active.retain(|one| one.fresh);
        renew(experiments, active).await?;
    }
    let found = all.into_iter();
    Ok(found
        .map(|one| one.map(|one| (one.cost, one.point.x)))
        .collect())
}

/// Computes new Jacobians at the current points of refits; a refit whose Jacobian fails is finished.
async fn renew<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    stale: Vec<&mut Descent>,
) -> Result<(), L::Error> {
    if stale.is_empty() {
        return Ok(());
    }
    let here = LeastSquaresSettings {
        iterations: 1,
        ..FREE
    };
    let points = stale.iter().map(|one| one.point.clone()).collect();
    let fits = experiments.fits(points, here).await?;
    for (one, fit) in stale.into_iter().zip(fits) {
        one.own += 1;
        match fit {
            Some(fit) => one.jacobian.clone_from(&fit.search.best().jacobian),
            None => one.over = true,
        }
    }
    Ok(())
}

/// Returns the point with the least cost of each set of points, with its cost and residual; `None` where no
/// point completes.
async fn best_of<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    sets: Vec<Vec<Point>>,
) -> Result<Vec<Option<(f64, DVector<f64>, Point)>>, L::Error> {
    let curves = experiments.curves(&sets.concat()).await?;
    let mut curves = curves.into_iter();
    let mut all = Vec::new();
    for set in sets {
        let mut best: Option<(f64, DVector<f64>, Point)> = None;
        for point in set {
            let Some(curves) = curves.next().flatten() else {
                continue;
            };
            let residual = experiments.on.residual(&curves);
            let variables = point.model.variables(&point.x);
            let cost = residual.norm_squared() + prior_cost(&point.x, &variables);
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, residual, point));
            }
        }
        all.push(best);
    }
    Ok(all)
}
