//! Log evidence of a fitted model (Laplace approximation): goodness of fit, penalised by the freedom of its
//! parameters.
//!
//! `ln Z = -1/2 (|r|^2 + u^T u) + 1/2 ln |L| - 1/2 ln |J^T J + L|`, with `u` the parameters in units of their
//! priors. Differences are divided by the dispersion `chi^2 / (n - p)` of the best model, at least 1: the
//! quasi-likelihood of an error whose variance is that multiple of the noise variance (Burnham & Anderson,
//! *Model Selection and Multimodel Inference*, 2.5).
use nalgebra::{Cholesky, Dyn};
use search::least_squares::{Linearized, Variable};

/// Returns the log evidence of a fitted model (nats), up to a constant of the record.
pub fn log_evidence(at: &Linearized, variables: &[Variable]) -> f64 {
    let mut curvature = at.jacobian.tr_mul(&at.jacobian);
    let mut penalty = 0.0;
    let mut prior = 0.0;
    for (k, v) in variables.iter().enumerate() {
        let deviation = deviation(v);
        let weight = 1.0 / (deviation * deviation);
        curvature[(k, k)] += weight;
        prior += 0.5 * libm::log(weight);
        if let Some(p) = v.prior {
            let u = (at.x[k] - p.mean) / p.deviation;
            penalty += u * u;
            // a prior cut in half by a bound at its mean is twice as dense
            if v.lower >= p.mean || v.upper <= p.mean {
                prior += std::f64::consts::LN_2;
            }
        }
    }
    let Some(factor) = curvature.cholesky() else {
        return f64::NEG_INFINITY;
    };
    let log_determinant = log_determinant(&factor);
    -0.5 * (at.residual.norm_squared() + penalty) + prior - 0.5 * log_determinant
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

    #[test]
    fn the_set_widens_with_the_dispersion_of_the_best() {
        let evidences = [-10.0, f64::NEG_INFINITY, -4.0, -6.5, -30.0];
        assert_eq!(ambiguity_set(&evidences, 1.0, 3.0), [2, 3]);
        assert_eq!(ambiguity_set(&evidences, 2.25, 3.0), [2, 3, 0]);
    }
}
