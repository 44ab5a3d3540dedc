//! Score (Lagrange multiplier) test of one effect on the residual of a fitted model.
//!
//! The statistic is the decrease of the cost of the linearised problem by the effect, every other unknown inside its
//! bounds. Where no bound holds an unknown it is `T^2 = r^T G (G^T B G)^-1 G^T r`, chi-squared under the null
//! hypothesis, with as many degrees of freedom as the effect has sizes. Without the bounds, an effect would be found
//! wherever it could stand beside a negative friction. For an effect whose size has a known sign the tail probability
//! is halved, and an estimate of the wrong sign counts against the effect.
use crate::linear::tangent::Tangent;
use nalgebra::{DMatrix, DVector};
use search::least_squares::{Linearized, Variable, linear_minimum, prior_cost};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF as _, FisherSnedecor};

/// Fitted model without the effect under test (null hypothesis), linearised.
#[derive(Clone, Debug)]
pub struct NullModel {
    /// Minimum of the linearised problem inside the bounds of the variables.
    minimum: Linearized,
    variables: Vec<Variable>,
    /// Changes of the prediction that recalibration can absorb at the minimum.
    pub tangent: Tangent,
}

impl NullModel {
    /// Linearises a fitted model.
    pub fn new(at: &Linearized, variables: &[Variable]) -> Self {
        let minimum = linear_minimum(at, variables);
        Self {
            tangent: Tangent::new(&minimum, variables),
            variables: variables.to_vec(),
            minimum,
        }
    }

    /// Returns the whitened residual `data - prediction` at the minimum.
    pub fn residual(&self) -> &DVector<f64> {
        &self.minimum.residual
    }

    /// Returns the decrease of the cost at the minimum by columns added to the prediction, with the amount of each.
    fn decrease(&self, columns: &DMatrix<f64>) -> (f64, DVector<f64>) {
        let p = self.variables.len();
        let m = columns.ncols();
        let mut with = self.minimum.clone();
        with.x.resize(p + m, 0.0);
        with.jacobian = with.jacobian.insert_columns(p, m, 0.0);
        with.jacobian.columns_mut(p, m).copy_from(&-columns);
        let mut variables = self.variables.clone();
        let amount = Variable {
            start: 0.0,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            step: 1.0,
            longest: f64::INFINITY,
            prior: None,
        };
        variables.resize(p + m, amount);
        let with = linear_minimum(&with, &variables);
        let cost =
            |at: &Linearized| at.residual.norm_squared() + prior_cost(&at.x[..p], &self.variables);
        let decrease = (cost(&self.minimum) - cost(&with)).max(0.0);
        (decrease, DVector::from_column_slice(&with.x[p..]))
    }
}

/// Result of a score test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Test statistic: decrease of the cost.
    pub statistic: f64,
    /// Degrees of freedom of the statistic: number of the effect's sizes that recalibration does not absorb.
    pub freedom: usize,
    /// Tail probability of the statistic under the null hypothesis, not corrected for the number of tests.
    pub p_value: f64,
    /// Estimated sizes of the effect, in the units of the signatures.
    pub size: Vec<f64>,
    /// Standard deviations of the estimated sizes; infinite for a size that recalibration absorbs completely.
    pub deviation: Vec<f64>,
    /// Share of the signature that recalibration absorbs, 0 to 1.
    pub absorbed: f64,
}

/// Share of the squared length of a signature below which its projection counts as zero, so that the
/// signature is absorbed.
const ABSORBED: f64 = 1e-9;

/// Tests signatures on the residual of a fitted model. A column of `signature` is the change of the whitened
/// prediction per unit of one size; `positive` marks sizes that cannot be negative.
pub fn score(null: &NullModel, signature: &DMatrix<f64>, positive: &[bool]) -> Score {
    let projected = null.tangent.project_columns(signature);
    let information = signature.tr_mul(&projected);
    let raw = signature.norm_squared();
    let absorbed = if raw > 0.0 {
        (1.0 - information.trace() / raw).clamp(0.0, 1.0)
    } else {
        1.0
    };
    let eigen = information.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let m = signature.ncols();
    let mut variance = DVector::zeros(m);
    let mut seen = Vec::with_capacity(m);
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if value.is_nan() || *value <= ABSORBED * raw.max(largest) {
            for (variance, v) in variance.iter_mut().zip(vector.iter()) {
                if v.abs() > 1e-3 {
                    *variance = f64::INFINITY;
                }
            }
            continue;
        }
        variance += vector.component_mul(&vector) / *value;
        seen.push(vector.into_owned());
    }
    let freedom = seen.len();
    let (statistic, size) = if freedom == 0 {
        (0.0, DVector::zeros(m))
    } else {
        let seen = DMatrix::from_columns(&seen);
        let (decrease, amounts) = null.decrease(&(signature * &seen));
        (decrease, seen * amounts)
    };
    let wrong_sign = |k: usize| positive.get(k).copied().unwrap_or(false) && size[k] < 0.0;
    let wrong = (0..m).any(wrong_sign);
    let p_value = if freedom == 0 || (wrong && m == 1) {
        1.0
    } else {
        let tail = chi_squared_tail(statistic, freedom);
        let one_sided = m == 1 && positive.first().copied().unwrap_or(false);
        if one_sided { 0.5 * tail } else { tail }
    };
    Score {
        statistic,
        freedom,
        p_value,
        size: size.iter().copied().collect(),
        deviation: variance.iter().map(|v| v.sqrt()).collect(),
        absorbed,
    }
}

/// Returns the probability that a chi-squared variable with `freedom` degrees of freedom exceeds `x`.
pub fn chi_squared_tail(x: f64, freedom: usize) -> f64 {
    ChiSquared::new(freedom.max(1) as f64).map_or(1.0, |law| law.sf(x.max(0.0)))
}

/// Returns the p-value of the misfit test: the upper tail of the F distribution for the squared length
/// `chi_squared` of a whitened residual of `n` entries after a fit of `parameters` unknowns, where the noise
/// variances are known with `freedom` degrees of freedom.
pub fn misfit_tail(chi_squared: f64, n: usize, parameters: f64, freedom: f64) -> f64 {
    let left = (n as f64 - parameters).max(1.0);
    // variances without doubt are like very many degrees of freedom
    FisherSnedecor::new(left, freedom.clamp(1.0, 1e9))
        .map_or(1.0, |law| law.sf((chi_squared / left).max(0.0)))
}

/// Returns the family-wise p-value of the smallest p-value among `tests` independent tests (Sidak).
pub fn family_wise(p_value: f64, tests: usize) -> f64 {
    // 1 - (1 - p)^k without cancellation
    -libm::expm1(tests as f64 * libm::log1p(-p_value.clamp(0.0, 1.0 - 1e-16)))
}

/// Returns the level of each of `tests` independent tests whose family has the level `alpha`: the inverse of
/// [`family_wise`].
pub fn single(alpha: f64, tests: usize) -> f64 {
    -libm::expm1(libm::log1p(-alpha) / tests.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Prior;

    fn null(residual: DVector<f64>, columns: &[DVector<f64>]) -> NullModel {
        let variable = Variable {
            start: 0.0,
            lower: -9.0,
            upper: 9.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: None,
        };
        let at = Linearized {
            x: vec![0.0; columns.len()],
            residual,
            jacobian: DMatrix::from_columns(columns),
        };
        NullModel::new(&at, &vec![variable; columns.len()])
    }

    fn basis(k: usize) -> DVector<f64> {
        DVector::from_fn(6, |i, _| if i == k { 1.0 } else { 0.0 })
    }

    #[test]
    fn the_size_of_a_planted_effect_comes_back() {
        let signature = DMatrix::from_columns(&[basis(0) * 4.0 + basis(1) * 3.0]);
        // the data hold 2 of it, of which the fit absorbs what it can
        let tested = |held: f64| {
            let null = null(signature.column(0) * held, &[basis(0)]);
            score(&null, &signature, &[true])
        };
        let found = tested(2.0);
        assert!((found.size[0] - 2.0).abs() < 1e-9);
        assert!((found.statistic - 36.0).abs() < 1e-9);
        assert!((found.deviation[0] - 1.0 / 3.0).abs() < 1e-9);
        assert!((found.absorbed - 16.0 / 25.0).abs() < 1e-9);
        // one-sided: half of P(chi2_1 > 36) = 1.97e-9
        assert!(
            (found.p_value / 9.87e-10 - 1.0).abs() < 0.01,
            "{}",
            found.p_value
        );
        let against = tested(-2.0);
        assert!((against.p_value - 1.0).abs() < 1e-12);
    }

    /// Checks that projected signatures select the true effect where raw signatures select a look-alike: the
    /// planted look-alike satisfies `rho^2 (1 - a_j) > 1 - a_k`, with the absorbed shares `a`.
    #[test]
    fn projection_names_the_truth_where_the_raw_test_names_the_impostor() {
        let fit = basis(0);
        // the truth is mostly absorbed, the impostor hardly, and they look alike in what is left
        let truth = basis(0) * 5.0 + basis(1) * 1.0 + basis(2) * 0.6;
        let impostor = basis(0) * 0.2 + basis(1) * 1.0 + basis(3) * 0.5;
        let null = null(truth.clone(), std::slice::from_ref(&fit));
        let statistic = |signature: &DVector<f64>| {
            let columns = DMatrix::from_columns(std::slice::from_ref(signature));
            score(&null, &columns, &[false]).statistic
        };
        assert!(statistic(&truth) > statistic(&impostor));
        let raw = |signature: &DVector<f64>| {
            let along = signature.dot(null.residual());
            along * along / signature.norm_squared()
        };
        assert!(raw(&truth) < raw(&impostor));
    }

    #[test]
    fn an_effect_that_recalibration_absorbs_cannot_be_seen() {
        let signature = DMatrix::from_columns(&[basis(0) * 7.0]);
        let found = score(&null(basis(1), &[basis(0)]), &signature, &[false]);
        assert_eq!(found.freedom, 0);
        assert!((found.p_value - 1.0).abs() < 1e-12 && found.deviation[0].is_infinite());
    }

    /// Checks that an effect which explains the data only beside a negative friction is not found, wherever the fit
    /// ended, and that its statistic is the decrease of the cost that its size and the friction inside its bounds
    /// make.
    #[test]
    fn no_effect_is_found_beside_a_negative_friction() {
        let friction = basis(0) * 3.0 + basis(1);
        let signature = DMatrix::from_columns(&[basis(0) * 3.0]);
        // what the effect and a friction of -5 would explain
        let data = basis(0) * 0.5 - basis(1) * 5.0;
        let variable = Variable {
            start: 0.0,
            lower: 0.0,
            upper: 9.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.0,
                deviation: 10.0,
            }),
        };
        let variables = [variable];
        for ended in [0.0, 0.3, 2.0] {
            let at = Linearized {
                x: vec![ended],
                residual: &data - &friction * ended,
                jacobian: DMatrix::from_columns(&[-&friction]),
            };
            let found = score(&NullModel::new(&at, &variables), &signature, &[false]);
            assert!((found.statistic - 0.25).abs() < 1e-9, "{ended}: {found:?}");
            assert!((found.size[0] - 0.5 / 3.0).abs() < 1e-9, "{found:?}");
            assert!((found.deviation[0] - 1.0 / 3.0).abs() < 1e-9, "{found:?}");
            assert!(
                found.absorbed.abs() < 1e-9 && found.freedom == 1,
                "{found:?}"
            );
        }
    }

    #[test]
    fn tails_and_families() {
        assert!((chi_squared_tail(3.841_458_820_694_124, 1) - 0.05).abs() < 1e-9);
        assert!((chi_squared_tail(11.070_497_693_516_351, 5) - 0.05).abs() < 1e-9);
        assert!((family_wise(0.001, 25) - (1.0 - 0.999_f64.powi(25))).abs() < 1e-12);
        assert!(family_wise(1e-300, 25) > 0.0);
        // F(1, many) is chi2_1, F(10, 10) has its median at 1
        assert!((misfit_tail(3.841_458_8, 3, 2.0, 1e9) - 0.05).abs() < 1e-6);
        assert!((misfit_tail(10.0, 12, 2.0, 10.0) - 0.5).abs() < 1e-9);
        assert!((family_wise(single(0.01, 25), 25) - 0.01).abs() < 1e-12);
    }
}
