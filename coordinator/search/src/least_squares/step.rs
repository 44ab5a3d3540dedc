//! Damped Gauss-Newton steps inside a box.
use super::problem::{Linearized, Settings, Variable};
use nalgebra::{DMatrix, DVector};

/// Dampings that are tried at once, relative to the last one that was taken.
const FAN: [f64; 5] = [1e-3, 0.03, 0.3, 3.0, 30.0];

/// Factor on the damping after a whole fan was refused.
pub(super) const REFUSED: f64 = 1e3;

/// The priors' part of the cost.
pub(super) fn prior_cost(x: &[f64], variables: &[Variable]) -> f64 {
    let part = |(x, v): (&f64, &Variable)| {
        v.prior.map_or(0.0, |prior| {
            let u = (x - prior.mean) / prior.deviation;
            u * u
        })
    };
    x.iter().zip(variables).map(part).sum()
}

/// Gradient and curvature of half the cost: `J^T r + L (x - mean)`, `J^T J + L`.
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

/// Whether a variable lies on a bound and the cost falls towards the outside.
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

/// Residual after an undamped step of the free variables.
pub(super) fn settled(at: &Linearized, variables: &[Variable]) -> DVector<f64> {
    let (gradient, curvature) = normal(at, variables);
    let free = free(at, variables, &gradient, &curvature);
    let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        // twelve digits below the diagonal: decides nothing, keeps the factor
        let ridge = if i == j { 1.0 + 1e-12 } else { 1.0 };
        ridge * curvature[(free[i], free[j])]
    });
    let right = DVector::from_fn(free.len(), |i, _| -gradient[free[i]]);
    matrix.cholesky().map_or_else(
        || at.residual.clone(),
        |factor| &at.residual + at.jacobian.select_columns(&free) * factor.solve(&right),
    )
}

/// Variables that a step may move: not those that press against a bound, nor those that change
/// nothing.
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

/// The damped steps from a linearised point: dampings with the points they lead to. Variables that
/// press against a bound stay; a variable that changes nothing stays.
pub(super) fn fan(
    at: &Linearized,
    variables: &[Variable],
    settings: &Settings,
    damping: f64,
) -> Vec<(f64, Vec<f64>)> {
    let (gradient, curvature) = normal(at, variables);
    let free = free(at, variables, &gradient, &curvature);
    if free.is_empty() {
        return Vec::new();
    }
    let total: f64 = free.iter().map(|&k| curvature[(k, k)]).sum();
    let level = settings.level * total / free.len() as f64;
    let mut fan: Vec<(f64, Vec<f64>)> = Vec::new();
    for factor in FAN {
        let damping = damping * factor;
        let mut matrix =
            DMatrix::from_fn(free.len(), free.len(), |i, j| curvature[(free[i], free[j])]);
        for i in 0..free.len() {
            matrix[(i, i)] *= 1.0 + damping;
            matrix[(i, i)] += damping * level;
        }
        let right = DVector::from_fn(free.len(), |i, _| -gradient[free[i]]);
        let Some(factor) = matrix.cholesky() else {
            continue;
        };
        let step = factor.solve(&right);
        let mut x = at.x.clone();
        for (i, &k) in free.iter().enumerate() {
            let step = step[i].clamp(-settings.longest, settings.longest);
            x[k] = (x[k] + step).clamp(variables[k].lower, variables[k].upper);
        }
        let met = x == at.x || fan.iter().any(|(_, other)| *other == x);
        if x.iter().all(|x| x.is_finite()) && !met {
            fan.push((damping, x));
        }
    }
    fan
}
