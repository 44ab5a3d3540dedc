//! Tangent space of the fitted model: the changes of the prediction that recalibration can absorb.
//!
//! `B x = x - J (J^T J + L)^-1 J^T x` removes from a whitened vector the part that the free parameters, each
//! held by its prior, would explain. Signatures of effects are tested after this projection, so that the part
//! that a recalibration hides counts neither for nor against an effect.
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use search::least_squares::{Linearized, Variable};

/// Returns the indices of the variables that are free at a point: strictly inside their bounds and with a
/// Jacobian column that is not zero.
pub(crate) fn free(at: &Linearized, variables: &[Variable]) -> Vec<usize> {
    let inside = |k: &usize| {
        let (x, v) = (at.x[*k], &variables[*k]);
        let moves = at.jacobian.column(*k).norm_squared() > 0.0;
        moves && x > v.lower && x < v.upper
    };
    (0..variables.len()).filter(inside).collect()
}

/// Projector onto the complement of a tangent space, regularised by the priors.
#[derive(Clone, Debug)]
pub struct Tangent {
    free: Vec<usize>,
    jacobian: DMatrix<f64>,
    /// Cholesky factor of `J^T J + L`; `None` where no variable is free.
    factor: Option<Cholesky<f64, Dyn>>,
}

impl Tangent {
    /// Builds the projector at a fitted point. Variables on a bound and variables without influence absorb
    /// nothing.
    pub fn new(at: &Linearized, variables: &[Variable]) -> Self {
        let free = free(at, variables);
        let jacobian = at.jacobian.select_columns(&free);
        let mut curvature = jacobian.tr_mul(&jacobian);
        for (i, &k) in free.iter().enumerate() {
            if let Some(prior) = variables[k].prior {
                curvature[(i, i)] += 1.0 / (prior.deviation * prior.deviation);
            }
            // twelve digits below the column itself: decides nothing, keeps the factor
            curvature[(i, i)] *= 1.0 + 1e-12;
        }
        let factor = if free.is_empty() {
            None
        } else {
            curvature.cholesky()
        };
        Self {
            free,
            jacobian,
            factor,
        }
    }

    /// Returns the number of free variables.
    pub fn dimension(&self) -> usize {
        self.jacobian.ncols()
    }

    /// Returns the effective number of parameters of the fit: the trace of the projector, which counts a
    /// variable with a prior by the share of its information that comes from the record (Hastie, Tibshirani,
    /// Friedman, *Elements of Statistical Learning*, 7.6).
    pub fn parameters(&self) -> f64 {
        self.factor.as_ref().map_or(0.0, |factor| {
            let curvature = self.jacobian.tr_mul(&self.jacobian);
            factor.solve(&curvature).trace()
        })
    }

    /// Returns the step of each free variable, with the variable's index, that best explains a whitened
    /// vector.
    pub(crate) fn estimate(&self, x: &DVector<f64>) -> Vec<(usize, f64)> {
        let Some(factor) = &self.factor else {
            return Vec::new();
        };
        let moved = factor.solve(&self.jacobian.tr_mul(x));
        self.free
            .iter()
            .copied()
            .zip(moved.iter().copied())
            .collect()
    }

    /// Returns the part of a whitened vector that changes of the free variables do not explain.
    pub fn project(&self, x: &DVector<f64>) -> DVector<f64> {
        match &self.factor {
            None => x.clone(),
            Some(factor) => x - &self.jacobian * factor.solve(&self.jacobian.tr_mul(x)),
        }
    }

    /// Returns the part of each column of a matrix that changes of the free variables do not explain.
    pub fn project_columns(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        match &self.factor {
            None => x.clone(),
            Some(factor) => x - &self.jacobian * factor.solve(&self.jacobian.tr_mul(x)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Prior;

    fn variable(prior: Option<f64>) -> Variable {
        Variable {
            start: 0.0,
            lower: -9.0,
            upper: 9.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: prior.map(|deviation| Prior {
                mean: 0.0,
                deviation,
            }),
        }
    }

    fn fitted() -> Linearized {
        Linearized {
            x: vec![0.0, 0.0, 9.0],
            residual: DVector::zeros(6),
            jacobian: DMatrix::from_fn(6, 3, |i, j| ((i * i + 3 * j * i + j) % 7) as f64 - 2.0),
        }
    }

    #[test]
    fn what_free_parameters_explain_vanishes_and_the_rest_is_orthogonal() {
        let at = fitted();
        let tangent = Tangent::new(&at, &[variable(None), variable(None), variable(None)]);
        // the third lies on its bound
        assert_eq!(tangent.dimension(), 2);
        let explained = at.jacobian.column(0) * 3.0 - at.jacobian.column(1);
        assert!(tangent.project(&explained).norm() < 1e-9);
        let x = DVector::from_fn(6, |i, _| (i as f64).sin());
        let left = tangent.project(&x);
        assert!(at.jacobian.column(0).dot(&left).abs() < 1e-9);
        assert!((tangent.project(&left) - &left).norm() < 1e-9);
        assert!(tangent.project(&at.jacobian.column(2).into_owned()).norm() > 0.1);
    }

    #[test]
    fn a_prior_lets_a_parameter_absorb_only_so_much() {
        let at = fitted();
        let narrow = Tangent::new(&at, &[variable(Some(1e-6)), variable(None), variable(None)]);
        let column = at.jacobian.column(0).into_owned();
        let other = Tangent::new(
            &Linearized {
                jacobian: at.jacobian.columns(1, 1).into_owned(),
                x: vec![0.0],
                residual: at.residual,
            },
            &[variable(None)],
        );
        assert!((narrow.project(&column) - other.project(&column)).norm() < 1e-6);
    }
}
