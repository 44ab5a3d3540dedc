//! Log evidence of a fitted model (Laplace approximation): goodness of fit, penalised by the freedom of its
//! parameters.
//!
//! `ln Z = -1/2 (|r|^2 + u^T u) + 1/2 ln |L| - 1/2 ln |J^T J + L|`, with `u` the parameters in units of their
//! priors. Differences are divided by the smaller dispersion of the two models, `chi^2 / (n - p)`, at least 1, and
//! 1 where a smooth discrepancy stands for it: the
//! quasi-likelihood of an error whose variance is that multiple of the noise variance (Burnham & Anderson,
//! *Model Selection and Multimodel Inference*, 2.5).
use crate::linear::tangent::free;
use nalgebra::{Cholesky, Dyn};
use search::least_squares::{Linearized, Variable};
use std::f64::consts::LN_2;

/// Returns the log evidence of a fitted model (nats), up to a constant of the record.
///
/// A variable that is pressed against a bound has half a Gaussian, or the tail of one, inside its range: it
/// contributes that integral, given all others, instead of a width that the bound cuts off. A variable without
/// influence contributes nothing.
pub fn log_evidence(at: &Linearized, variables: &[Variable]) -> f64 {
    let free = free(at, variables);
    let jacobian = at.jacobian.select_columns(&free);
    let mut curvature = jacobian.tr_mul(&jacobian);
    let mut sum = -0.5 * at.residual.norm_squared();
    for (i, &k) in free.iter().enumerate() {
        curvature[(i, i)] += precision(&variables[k]);
        sum += 0.5 * libm::log(precision(&variables[k]));
    }
    for (x, v) in at.x.iter().zip(variables) {
        let Some(p) = v.prior else { continue };
        let u = (x - p.mean) / p.deviation;
        sum -= 0.5 * u * u;
    }
    let factor = if free.is_empty() {
        None
    } else {
        let Some(factor) = curvature.cholesky() else {
            return f64::NEG_INFINITY;
        };
        sum -= 0.5 * log_determinant(&factor);
        Some(factor)
    };
    // a prior cut in half by a bound at its mean is twice as dense
    let halved = |k: &usize| {
        variables[*k]
            .prior
            .is_some_and(|p| variables[*k].lower >= p.mean || variables[*k].upper <= p.mean)
    };
    let moves = |k: &usize| at.jacobian.column(*k).norm_squared() > 0.0;
    let there = (0..variables.len()).filter(moves);
    sum += LN_2 * there.clone().filter(halved).count() as f64;
    let held = |k: &usize| variables[*k].lower >= variables[*k].upper;
    let on_bound = there.filter(|k| !free.contains(k) && !held(k));
    sum + on_bound
        .map(|k| {
            let column = at.jacobian.column(k).into_owned();
            let projected = match &factor {
                None => column.clone(),
                Some(factor) => &column - &jacobian * factor.solve(&jacobian.tr_mul(&column)),
            };
            let precision = precision(&variables[k]);
            let slope = column.dot(&at.residual)
                + variables[k]
                    .prior
                    .map_or(0.0, |p| (at.x[k] - p.mean) * precision);
            let curvature = projected.dot(&column) + precision;
            let inwards = if at.x[k] <= variables[k].lower {
                slope
            } else {
                -slope
            };
            0.5 * libm::log(precision) + log_share_inside(inwards.max(0.0) / curvature.sqrt())
                - 0.5 * libm::log(curvature)
        })
        .sum::<f64>()
}

/// Returns the logarithm of the mean of `exp` of several values; `NaN` where one is.
pub(crate) fn log_mean(values: &[f64]) -> f64 {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if values.iter().any(|value| value.is_nan()) || !largest.is_finite() {
        return values.iter().sum();
    }
    let sum: f64 = values.iter().map(|value| libm::exp(value - largest)).sum();
    largest + libm::log(sum / values.len() as f64)
}

/// Returns the logarithm of the integral of `exp(-slope t - t^2 / 2)` over `t > 0`, relative to that of the
/// whole Gaussian `exp(-t^2 / 2)`.
fn log_share_inside(slope: f64) -> f64 {
    /// Slope from which the first two terms of the asymptotic series have six digits.
    const STEEP: f64 = 30.0;
    if slope > STEEP {
        let tail = 1.0 - 1.0 / (slope * slope);
        return libm::log(tail / slope) - 0.5 * libm::log(std::f64::consts::TAU);
    }
    0.5 * slope * slope + libm::log(0.5 * libm::erfc(slope / std::f64::consts::SQRT_2))
}

/// Returns the prior precision of a variable.
fn precision(variable: &Variable) -> f64 {
    let deviation = deviation(variable);
    1.0 / (deviation * deviation)
}

/// Returns the prior standard deviation of a variable: that of its prior or, without one, of a uniform
/// distribution between its bounds.
pub(crate) fn deviation(variable: &Variable) -> f64 {
    let width = variable.upper - variable.lower;
    let prior = variable.prior.map(|prior| prior.deviation);
    prior.unwrap_or(width / 12_f64.sqrt())
}

/// Returns the logarithm of the determinant of a factorised matrix.
pub(crate) fn log_determinant(factor: &Cholesky<f64, Dyn>) -> f64 {
    let diagonal = factor.l_dirty().diagonal();
    diagonal.iter().map(|d| 2.0 * libm::log(*d)).sum()
}

/// Returns the indices of the models whose log evidence, divided by `dispersion`, lies within `margin` nats
/// of the best model's; the best model comes first.
pub fn ambiguity_set(evidences: &[f64], dispersion: f64, margin: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..evidences.len())
        .filter(|&i| evidences[i].is_finite())
        .collect();
    order.sort_by(|&a, &b| evidences[b].total_cmp(&evidences[a]).then(a.cmp(&b)));
    let best = order.first().map_or(0.0, |&i| evidences[i]);
    order.retain(|&i| best - evidences[i] < margin * dispersion);
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use search::least_squares::Prior;

    /// Checks the mean of densities far below the smallest number, and that a value that is no number stays one.
    #[test]
    fn the_mean_of_densities_is_taken_in_logarithms() {
        let three = -9000.0 + libm::log(3.0);
        let mean = log_mean(&[-9000.0, three]);
        assert!((mean - (-9000.0 + libm::log(2.0))).abs() < 1e-9, "{mean}");
        assert!((log_mean(&[f64::NEG_INFINITY, 0.0]) + libm::log(2.0)).abs() < 1e-12);
        assert!(log_mean(&[f64::NAN, 0.0]).is_nan());
    }

    #[test]
    fn evidence_of_a_linear_model_is_the_exact_one() {
        // y = a g + noise, a ~ N(0, s^2): y ~ N(0, I + s^2 g g^T)
        let g = DVector::from_vec(vec![1.0, 2.0, -0.5]);
        let y = DVector::from_vec(vec![0.7, 1.1, 0.4]);
        let s: f64 = 1.5;
        let covariance = DMatrix::identity(3, 3) + &g * g.transpose() * (s * s);
        let solved = covariance.clone().lu().solve(&y).unwrap();
        let exact = -0.5 * y.dot(&solved) - 0.5 * covariance.determinant().ln();
        let a = g.dot(&y) / (g.norm_squared() + 1.0 / (s * s));
        let at = Linearized {
            x: vec![a],
            residual: &y - &g * a,
            jacobian: DMatrix::from_columns(&[-g]),
        };
        let variable = Variable {
            start: 0.0,
            lower: -99.0,
            upper: 99.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.0,
                deviation: s,
            }),
        };
        assert!((log_evidence(&at, &[variable]) - exact).abs() < 1e-12);
    }

    /// Compares the evidence of an effect whose size cannot be negative with the integral over its size, for
    /// data that ask for a positive size, for none and for a negative one.
    #[test]
    fn evidence_on_a_bound_is_the_integral_inside() {
        let g = DVector::from_vec(vec![1.0, 2.0, -0.5]);
        let s = 1.5;
        for wanted in [3.0, 0.4, 0.0, -0.7, -60.0] {
            let y = &g * wanted + DVector::from_vec(vec![0.2, -0.1, 0.0]);
            let cost = |a: f64| 0.5 * (&y - &g * a).norm_squared() + 0.5 * (a / s).powi(2);
            let a = (g.dot(&y) / (g.norm_squared() + 1.0 / (s * s))).max(0.0);
            let step = 1e-5;
            let values = (0..600_000).map(|i| (cost(a) - cost((f64::from(i) + 0.5) * step)).exp());
            let density = 2.0 / (s * std::f64::consts::TAU.sqrt());
            let exact = -cost(a) + (values.sum::<f64>() * step * density).ln();
            let at = Linearized {
                x: vec![a],
                residual: &y - &g * a,
                jacobian: DMatrix::from_columns(&[-g.clone()]),
            };
            let variable = Variable {
                start: 0.0,
                lower: 0.0,
                upper: 99.0,
                step: 0.1,
                longest: f64::INFINITY,
                prior: Some(Prior {
                    mean: 0.0,
                    deviation: s,
                }),
            };
            let found = log_evidence(&at, &[variable]);
            // Laplace cuts nothing off an inner maximum, though a bound near it does
            let near = if a > 0.0 && wanted < 1.0 { 0.3 } else { 2e-4 };
            assert!((found - exact).abs() < near, "{wanted}: {found} {exact}");
        }
    }

    #[test]
    fn the_set_widens_with_the_dispersion_of_the_best() {
        let evidences = [-10.0, f64::NEG_INFINITY, -4.0, -6.5, -30.0];
        assert_eq!(ambiguity_set(&evidences, 1.0, 3.0), [2, 3]);
        assert_eq!(ambiguity_set(&evidences, 2.25, 3.0), [2, 3, 0]);
    }
}
