//! Damped Gauss-Newton steps of the least-squares search inside the box of the variables' bounds.
use super::problem::{Linearized, Variable};
use nalgebra::{DMatrix, DVector};

/// Damping factors tried in one batch (a fan) of steps, relative to the last accepted damping.
const FAN: [f64; 5] = [1e-3, 0.03, 0.3, 3.0, 30.0];

/// Factor by which the damping is increased after no step of a fan lowered the cost.
pub(super) const REFUSED: f64 = 1e3;

/// Returns the contribution of the priors to the cost: `sum ((x_k - mean_k) / deviation_k)^2`.
pub fn prior_cost(x: &[f64], variables: &[Variable]) -> f64 {
    let part = |(x, v): (&f64, &Variable)| {
        v.prior.map_or(0.0, |prior| {
            let u = (x - prior.mean) / prior.deviation;
            u * u
        })
    };
    x.iter().zip(variables).map(part).sum()
}

/// Returns gradient and curvature of half the cost, with the prior precision L: `J^T r + L (x - mean)` and
/// `J^T J + L`.
fn normal(at: &Linearized, variables: &[Variable]) -> (DVector<f64>, DMatrix<f64>) {
    let mut gradient = at.jacobian.tr_mul(&at.residual);
    let mut curvature = at.jacobian.tr_mul(&at.jacobian);
    for (k, v) in variables.iter().enumerate() {
        if let Some(prior) = v.prior {
            let weight = 1.0 / (prior.deviation * prior.deviation);
            gradient[k] += weight * (at.x[k] - prior.mean);
            curvature[(k, k)] += weight;
        }
    }
    (gradient, curvature)
}

/// Returns whether a variable lies on a bound and the cost decreases towards the outside.
fn pressed(x: f64, variable: &Variable, gradient: f64) -> bool {
    (x <= variable.lower && gradient > 0.0) || (x >= variable.upper && gradient < 0.0)
}

pub(super) fn gradient_ratio(at: &Linearized, variables: &[Variable], cost: f64) -> f64 {
    let (gradient, curvature) = normal(at, variables);
    let norm = cost.sqrt();
    let mut worst: f64 = 0.0;
    for (k, v) in variables.iter().enumerate() {
        let column = curvature[(k, k)].sqrt();
        if column > 0.0 && norm > 0.0 && !pressed(at.x[k], v, gradient[k]) {
            worst = worst.max(gradient[k].abs() / (column * norm));
        }
    }
    worst
}

/// Returns the minimum of the linearised problem inside the box: its point and residual, with the Jacobian of the
/// linearisation. Variables without any effect on the cost stay where they are.
pub fn linear_minimum(at: &Linearized, variables: &[Variable]) -> Linearized {
    /// Maximum number of steps; each but the first frees variables that the one before left at a bound.
    const STEPS: usize = 20;
    let cost = |at: &Linearized| at.residual.norm_squared() + prior_cost(&at.x, variables);
    let mut minimum = at.clone();
    let mut least = cost(&minimum);
    for _ in 0..STEPS {
        // twelve digits below the diagonal: decides nothing, keeps the factor
        let Some(step) = step(&minimum, variables, [1e-12, 0.0], false) else {
            break;
        };
        let mut next = minimum.clone();
        next.residual += &next.jacobian * &step;
        for ((x, step), v) in next.x.iter_mut().zip(step.iter()).zip(variables) {
            // exactly, as the sum need not be
            *x = if (step - (v.lower - *x)).abs() <= 0.0 {
                v.lower
            } else if (step - (v.upper - *x)).abs() <= 0.0 {
                v.upper
            } else {
                (*x + step).clamp(v.lower, v.upper)
            };
        }
        let reached = cost(&next);
        // several components that end at bounds may raise the cost by more than rounding
        if reached.is_nan() || reached > (1.0 + 1e-12) * least {
            break;
        }
        (minimum, least) = (next, reached);
        if !is_held(&minimum, variables) {
            break;
        }
    }
    minimum
}

/// Returns whether a variable lies on a bound although the cost decreases towards the inside.
fn is_held(at: &Linearized, variables: &[Variable]) -> bool {
    /// Cosine between a column and the residual below which the cost counts as flat.
    const FLAT: f64 = 1e-9;
    let (gradient, curvature) = normal(at, variables);
    let norm = (at.residual.norm_squared() + prior_cost(&at.x, variables)).sqrt();
    let mut all = variables.iter().enumerate();
    all.any(|(k, v)| {
        let steep = gradient[k].abs() > FLAT * curvature[(k, k)].sqrt() * norm;
        let on_bound = at.x[k] <= v.lower || at.x[k] >= v.upper;
        on_bound && steep && v.lower < v.upper && !pressed(at.x[k], v, gradient[k])
    })
}

/// Returns the slightly damped step to the minimum of the linearised problem inside the box, no component
/// longer than its variable's `longest`; `None` if the curvature has no Cholesky factor or no variable is
/// free.
pub fn undamped(at: &Linearized, variables: &[Variable]) -> Option<DVector<f64>> {
    step(at, variables, [1e-4, 1e-3], true)
}

/// Returns a damped step that stays in the box: a component that would leave the box ends at its bound, and
/// the remaining components are solved for again. Each component is damped by its own curvature, and by a
/// share `level` of the mean curvature. If `limited`, no component is longer than its variable's `longest`.
/// `None` if the curvature has no Cholesky factor or no variable is free.
fn step(
    at: &Linearized,
    variables: &[Variable],
    [damping, level]: [f64; 2],
    limited: bool,
) -> Option<DVector<f64>> {
    let (gradient, curvature) = normal(at, variables);
    let mut free = free(at, variables, &gradient, &curvature);
    let mut step = DVector::zeros(variables.len());
    if free.is_empty() {
        return None;
    }
    let mut right = -gradient;
    let whole: f64 = free.iter().map(|&k| curvature[(k, k)]).sum();
    let held = damping * level * whole / free.len() as f64;
    loop {
        let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            let own = curvature[(free[i], free[j])];
            if i == j {
                own * (1.0 + damping) + held
            } else {
                own
            }
        });
        let own = DVector::from_fn(free.len(), |i, _| right[free[i]]);
        let solved = matrix.cholesky()?.solve(&own);
        let mut kept = Vec::with_capacity(free.len());
        for (&k, &moved) in free.iter().zip(solved.iter()) {
            let v = &variables[k];
            let mut inside = moved.clamp(v.lower - at.x[k], v.upper - at.x[k]);
            if limited {
                inside = inside.clamp(-v.longest, v.longest);
            }
            step[k] = inside;
            // a step that is not a number is kept: it is refused later
            if (inside - moved).abs() > 0.0 {
                right -= curvature.column(k) * inside;
            } else {
                kept.push(k);
            }
        }
        if kept.len() == free.len() || kept.is_empty() {
            return Some(step);
        }
        free = kept;
    }
}

/// Returns the variables that a step may move: those neither pressed against a bound nor without any effect
/// on the cost.
fn free(
    at: &Linearized,
    variables: &[Variable],
    gradient: &DVector<f64>,
    curvature: &DMatrix<f64>,
) -> Vec<usize> {
    (0..variables.len())
        .filter(|&k| curvature[(k, k)] > 0.0 && !pressed(at.x[k], &variables[k], gradient[k]))
        .collect()
}

/// Returns steps with several dampings (a fan) from a linearised point: each damping with the point that its
/// step leads to. Variables pressed against a bound, or without any effect on the cost, stay fixed.
pub(super) fn fan(
    at: &Linearized,
    variables: &[Variable],
    (damping, level): (f64, f64),
) -> Vec<(f64, Vec<f64>)> {
    let mut fan: Vec<(f64, Vec<f64>)> = Vec::new();
    for factor in FAN {
        let damping = damping * factor;
        let Some(step) = step(at, variables, [damping, level], true) else {
            continue;
        };
        let moved = at.x.iter().zip(step.iter()).zip(variables);
        let x: Vec<f64> = moved
            .map(|((x, step), v)| (x + step).clamp(v.lower, v.upper))
            .collect();
        let met = x == at.x || fan.iter().any(|(_, other)| *other == x);
        if x.iter().all(|x| x.is_finite()) && !met {
            fan.push((damping, x));
        }
    }
    fan
}
