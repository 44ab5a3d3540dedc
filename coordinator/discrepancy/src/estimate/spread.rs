//! Uncertainty of the unknowns of a fit: their covariance, and the quantile of their intervals.
//!
//! With the Jacobian `J` of the whitened residual and the prior precision `L`, the covariance is `(J^T J /
//! s^2 + L)^-1`, where `s^2 = chi^2 / (n - p)` is the dispersion, as usual for least squares. The dispersion
//! is at least 1 where the noise was seen or stated, since its variance is then known.
//!
//! The residual may be coloured: a model of the wrong shape leaves slow waves, and unknowns that act slowly
//! are then less well known than for independent entries. With the power `S` of the residual, wave by wave
//! and times `n / (n - p)`, the covariance is the sandwich `A^-1 (J^T S J / s^4 + L) A^-1`, `A = J^T J /
//! s^2 + L` (White 1980, HC1 of `MacKinnon` & White 1985; in waves a stationary error is independent, so that its
//! autocovariance needs no estimate). Beside a smooth discrepancy of covariance `C = I + D D^T` the middle factor is
//! `J^T C J`, and the dispersion 1. No variance falls below the one for white residuals. An unknown on a
//! bound counts as known for all others, and has the variance that it would have if it alone were free.
use crate::linear::tangent::free;
use crate::localisation::residual::Residual;
use crate::localisation::{order, whiteness};
use crate::model::fit::Fit;
use crate::thresholds::COLOURED;
use nalgebra::{Complex, DMatrix, DVector};
use record::metric::Metric;
use record::noise::NoiseSource;
use record::noise::student;
use record::spectrum::Spectra;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Uncertainty of the unknowns of a fit.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Variance of a residual entry, in units of the noise variance.
    pub dispersion: f64,
    /// Half-width of a 95 % interval in standard deviations.
    pub quantile: f64,
    /// Covariance of the unknowns; `None` where the information matrix is singular.
    pub covariance: Option<DMatrix<f64>>,
    /// Factor by which each standard deviation exceeds that for white residuals; 1 where the residual is
    /// white.
    pub growth: DVector<f64>,
}

impl Spread {
    /// Computes the uncertainty of a fit to a record in a metric.
    pub fn of(metric: &Metric, fit: &Fit) -> Self {
        let freedom = fit.freedom();
        let per_freedom = fit.chi_squared() / freedom;
        // a residual without freedom tells no variance
        let tells = freedom > 1.0 && per_freedom > 0.0;
        let known = !(matches!(metric.known(), NoiseSource::Estimated) && tells);
        let dispersion = if known { fit.dispersion() } else { per_freedom };
        // a variance that comes from the residual is known as well as that; else as well as the noise's
        let noise = metric.freedom_of_intervals();
        let behind = if dispersion > 1.0 || !known {
            freedom.min(noise)
        } else {
            noise
        };
        let count = fit.x().len();
        let (covariance, growth) = covariance(metric, fit, dispersion).map_or_else(
            || (None, DVector::from_element(count, 1.0)),
            |(covariance, growth)| (Some(covariance), growth),
        );
        Self {
            dispersion,
            quantile: student(behind),
            covariance,
            growth,
        }
    }

    /// Returns the variance of an unknown; infinite where there is no covariance.
    pub fn variance(&self, k: usize) -> f64 {
        let own = self.covariance.as_ref().map(|c| c[(k, k)]);
        own.unwrap_or(f64::INFINITY)
    }

    /// Returns whether the joint 95 % confidence region of some unknowns of the point `x` contains 0: an ellipsoid, for
    /// one unknown its interval. Unknowns that the record does not determine are left out; `true` if none is left.
    pub fn region_contains_zero(&self, x: &[f64], of: &[usize]) -> bool {
        let determined = of.iter().copied().filter(|&k| self.variance(k).is_finite());
        let of: Vec<usize> = determined.collect();
        let Some(covariance) = self.covariance.as_ref().filter(|_| !of.is_empty()) else {
            return true;
        };
        let own = covariance.select_rows(&of).select_columns(&of);
        let from = DVector::from_iterator(of.len(), of.iter().map(|&k| x[k]));
        let chi_squared = |freedom: usize| {
            let law = ChiSquared::new(freedom as f64);
            law.map_or(f64::INFINITY, |law| law.inverse_cdf(0.95))
        };
        // as much wider than for a known variance as the interval of one unknown
        let wider = self.quantile * self.quantile / chi_squared(1);
        own.cholesky()
            .is_none_or(|own| from.dot(&own.solve(&from)) <= chi_squared(of.len()) * wider)
    }

    /// Returns how much minus twice the log likelihood rises from its minimum to the ends of an unknown's 95
    /// % interval, for a white residual.
    pub fn rise(&self) -> f64 {
        self.quantile * self.quantile * self.dispersion
    }

    /// Returns the largest growth of a standard deviation by coloured residuals; `None` where there is no
    /// growth of more than 1 %.
    pub fn largest_growth(&self) -> Option<f64> {
        let largest = self.growth.iter().copied().fold(1.0, f64::max);
        // a hundredth shows in no interval that is printed
        (largest > 1.01).then_some(largest)
    }
}

/// Describes in words how much a coloured residual widens intervals.
pub fn coloured(growth: f64) -> String {
    format!(
        "the residual is not white: it is concentrated in slow waves, so intervals are up to {growth:.2} times as wide as for independent errors of the same size"
    )
}

/// Computes the covariance of a fit's unknowns under a dispersion, and the factor by which a coloured
/// residual widens each standard deviation; `None` where the information matrix is singular.
fn covariance(metric: &Metric, fit: &Fit, dispersion: f64) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let at = fit.search.best();
    let used = free(at, fit.variables());
    let jacobian = at.jacobian.select_columns(&used);
    let prior = prior(fit, &used);
    let waves = fit.waves();
    let information = jacobian.tr_mul(&jacobian) / dispersion + &prior;
    let white = if used.is_empty() {
        information
    } else {
        information.cholesky()?.inverse()
    };
    let mut own = white.clone();
    let mut growth = DVector::from_element(used.len(), 1.0);
    let meat = if waves.ncols() > 0 {
        let mixed = waves.tr_mul(&jacobian);
        Some(jacobian.tr_mul(&jacobian) + mixed.tr_mul(&mixed))
    } else {
        meat(metric, fit, &jacobian, dispersion)
    };
    if let Some(meat) = meat {
        own = &white * (meat / (dispersion * dispersion) + prior) * &white;
        for k in 0..used.len() {
            let wider = own[(k, k)] / white[(k, k)];
            growth[k] = wider.max(1.0).sqrt();
            // its correlations, and no variance below that for white residuals
            let scale = (1.0 / wider).max(1.0).sqrt();
            own.row_mut(k).scale_mut(scale);
            own.column_mut(k).scale_mut(scale);
        }
    }
    let count = fit.x().len();
    let mut whole = DMatrix::zeros(count, count);
    let mut growths = DVector::from_element(count, 1.0);
    let fixed = (0..count).filter(|k| !used.contains(k));
    for k in fixed {
        whole[(k, k)] = alone(fit, &used, k);
    }
    for (i, &k) in used.iter().enumerate() {
        growths[k] = growth[i];
        for (j, &l) in used.iter().enumerate() {
            whole[(k, l)] = own[(i, j)];
        }
    }
    Some((whole, growths))
}

/// Returns the prior precision matrix of the unknowns with the indices `of` in a fit.
fn prior(fit: &Fit, of: &[usize]) -> DMatrix<f64> {
    let deviations = of
        .iter()
        .map(|&k| fit.variables()[k].prior.map(|p| p.deviation));
    let precisions =
        deviations.map(|own| own.map_or(0.0, |deviation| 1.0 / (deviation * deviation)));
    DMatrix::from_diagonal(&DVector::from_iterator(of.len(), precisions))
}

/// Returns the variance that the `k`-th unknown, which is on a bound, would have if it were free in addition
/// to the unknowns `used`; infinite where the record does not determine it.
fn alone(fit: &Fit, used: &[usize], k: usize) -> f64 {
    let all: Vec<usize> = used.iter().copied().chain([k]).collect();
    let jacobian = fit.search.best().jacobian.select_columns(&all);
    let information = jacobian.tr_mul(&jacobian) / fit.misfit() + prior(fit, &all);
    let inverse = information.cholesky().map(|own| own.inverse());
    inverse.map_or(f64::INFINITY, |own| own[(used.len(), used.len())])
}

/// Computes the middle factor `J^T S J` of the sandwich covariance, with the power `S` of the residual wave
/// by wave, for columns of the Jacobian; `None` where the residual is white.
fn meat(
    metric: &Metric,
    fit: &Fit,
    jacobian: &DMatrix<f64>,
    dispersion: f64,
) -> Option<DMatrix<f64>> {
    let left = fit.search.linear_minimum_residual();
    let powers = order::powers(&Residual {
        values: &left,
        metric,
        tangent: &fit.tangent(),
    });
    if whiteness::p_value(&powers, metric.freedom()) >= COLOURED {
        return None;
    }
    let correction = fit.entries() as f64 / fit.freedom();
    let level = |waves: &Vec<Complex<f64>>| {
        let powers = waves.iter().map(|wave| 0.5 * correction * wave.norm_sqr());
        smoothed(&powers.collect::<Vec<f64>>())
    };
    let levels: Vec<Vec<f64>> = metric.waves(&left).iter().map(level).collect();
    let columns = jacobian.column_iter();
    let waves: Vec<Spectra> = columns.map(|own| metric.waves(&own.into_owned())).collect();
    // what lies in no wave counts by the dispersion
    let mut meat = jacobian.tr_mul(jacobian) * dispersion;
    for (i, a) in waves.iter().enumerate() {
        for (j, b) in waves.iter().enumerate() {
            let channels = a.iter().zip(b).zip(&levels);
            let excess = channels.map(|((a, b), levels)| {
                let each = a.iter().zip(b).zip(levels);
                each.map(|((a, b), level)| (level - dispersion) * (a.conj() * b).re)
                    .sum::<f64>()
            });
            meat[(i, j)] += excess.sum::<f64>();
        }
    }
    Some(meat)
}

/// Returns the powers, each averaged over a neighbourhood that is narrow at the slow waves, where a model of
/// the wrong shape leaves most.
fn smoothed(powers: &[f64]) -> Vec<f64> {
    let mean = |k: usize| {
        let reach = 1 + k / 4;
        let about = &powers[k.saturating_sub(reach)..(k + reach + 1).min(powers.len())];
        about.iter().sum::<f64>() / about.len() as f64
    };
    (0..powers.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that sizes which may each be absent, but not both, are told from those that may both be, and that the
    /// region of a single unknown is its interval.
    #[test]
    fn a_region_holds_zero_where_all_may_be_absent_together() {
        let spread = Spread {
            dispersion: 1.0,
            quantile: 1.96,
            covariance: Some(DMatrix::from_row_slice(2, 2, &[1.0, -0.99, -0.99, 1.0])),
            growth: DVector::from_element(2, 1.0),
        };
        assert!(!spread.region_contains_zero(&[1.0, 1.0], &[0, 1]));
        assert!(spread.region_contains_zero(&[1.0, -1.0], &[0, 1]));
        assert!(spread.region_contains_zero(&[1.95, 9.0], &[0]));
        assert!(!spread.region_contains_zero(&[9.0, 1.97], &[1]));
    }
}
