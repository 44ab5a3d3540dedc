//! How far a record leaves the unknowns of a fit open: their covariance, and the quantile of their intervals.
//!
//! With the Jacobian `J` of the whitened residual and the precision `L` of what is known beforehand, the covariance is
//! `(J^T J / s^2 + L)^-1`, where `s^2 = chi^2 / (n - p)` is the dispersion: the textbook's for least squares. It is at
//! least 1 where the noise was seen or stated, for then its variance is known.
//!
//! What is left may be coloured: a law of the wrong shape leaves slow waves, and unknowns that act slowly are known less
//! well than as many independent entries would have it. With the power `S` of the residual, wave by wave and times
//! `n / (n - p)`, the covariance is the sandwich `A^-1 (J^T S J / s^4 + L) A^-1`, `A = J^T J / s^2 + L` (White 1980, HC1
//! of `MacKinnon` & White 1985; in waves a stationary error is independent, so that its autocovariance needs no estimate).
//! No variance falls below the one for white residuals. What stands at a bound is known as well as
//! that to all others, and has the variance that it would have if it alone were free.
use crate::linear::score::student;
use crate::linear::tangent::free;
use crate::model::fit::Fit;
use crate::place::residual::Residual;
use crate::place::{order, whiteness};
use crate::record::metric::Metric;
use crate::record::noise::Known;
use crate::record::spectrum::Spectra;
use crate::thresholds::COLOURED;
use nalgebra::{Complex, DMatrix, DVector};

/// How far a record leaves the unknowns of a fit open.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Variance of an entry of the residual, in units of the noise's.
    pub dispersion: f64,
    /// Half-width of a 95 % interval in standard deviations.
    pub quantile: f64,
    /// Covariance of the unknowns; none where one of them is left open.
    pub covariance: Option<DMatrix<f64>>,
    /// By how much each standard deviation exceeds that for white residuals; ones where they are white.
    pub growth: DVector<f64>,
}

impl Spread {
    /// Of a fit to a record in a metric.
    pub fn of(metric: &Metric, fit: &Fit) -> Self {
        let freedom = fit.freedom();
        let per_freedom = fit.chi_squared() / freedom;
        // a residual without freedom tells no variance
        let tells = freedom > 1.0 && per_freedom > 0.0;
        let known = !(matches!(metric.known(), Known::Guessed) && tells);
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

    /// Variance of an unknown; infinite where it is open.
    pub fn variance(&self, k: usize) -> f64 {
        let own = self.covariance.as_ref().map(|c| c[(k, k)]);
        own.unwrap_or(f64::INFINITY)
    }

    /// By how much minus twice the log likelihood rises at the ends of an interval of an unknown where what is left is white.
    pub fn rise(&self) -> f64 {
        self.quantile * self.quantile * self.dispersion
    }

    /// The largest growth by colour, where there is any.
    pub fn largest_growth(&self) -> Option<f64> {
        let largest = self.growth.iter().copied().fold(1.0, f64::max);
        // a hundredth shows in no interval that is printed
        (largest > 1.01).then_some(largest)
    }
}

/// How much the colour of what is left widens intervals, in words.
pub fn coloured(growth: f64) -> String {
    format!(
        "what is left is not white: it lies in slow waves, so that intervals are up to {growth:.2} times as wide as \
         independent errors of the same size would make them"
    )
}

/// Covariance of a fit's unknowns under a dispersion, and by how much the colour of what is left widens each standard
/// deviation; nothing where one of them is left open.
fn covariance(metric: &Metric, fit: &Fit, dispersion: f64) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let at = fit.search.best();
    let used = free(at, fit.variables());
    let jacobian = at.jacobian.select_columns(&used);
    let prior = prior(fit, &used);
    let information = jacobian.tr_mul(&jacobian) / dispersion + &prior;
    let white = if used.is_empty() {
        information
    } else {
        information.cholesky()?.inverse()
    };
    let mut own = white.clone();
    let mut growth = DVector::from_element(used.len(), 1.0);
    if let Some(meat) = meat(metric, fit, &jacobian, dispersion) {
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
        whole[(k, k)] = alone(fit, &used, k, dispersion);
    }
    for (i, &k) in used.iter().enumerate() {
        growths[k] = growth[i];
        for (j, &l) in used.iter().enumerate() {
            whole[(k, l)] = own[(i, j)];
        }
    }
    Some((whole, growths))
}

/// Precision of what is known beforehand of some of a fit's unknowns.
fn prior(fit: &Fit, of: &[usize]) -> DMatrix<f64> {
    let deviations = of
        .iter()
        .map(|&k| fit.variables()[k].prior.map(|p| p.deviation));
    let precisions =
        deviations.map(|own| own.map_or(0.0, |deviation| 1.0 / (deviation * deviation)));
    DMatrix::from_diagonal(&DVector::from_iterator(of.len(), precisions))
}

/// Variance of an unknown beside those that are free, if it were free too; infinite where it is open.
fn alone(fit: &Fit, used: &[usize], k: usize, dispersion: f64) -> f64 {
    let all: Vec<usize> = used.iter().copied().chain([k]).collect();
    let jacobian = fit.search.best().jacobian.select_columns(&all);
    let information = jacobian.tr_mul(&jacobian) / dispersion + prior(fit, &all);
    let inverse = information.cholesky().map(|own| own.inverse());
    inverse.map_or(f64::INFINITY, |own| own[(used.len(), used.len())])
}

/// `J^T S J` with the power of what a fit leaves, wave by wave, for columns of its Jacobian; none where that is white.
fn meat(
    metric: &Metric,
    fit: &Fit,
    jacobian: &DMatrix<f64>,
    dispersion: f64,
) -> Option<DMatrix<f64>> {
    let left = fit.search.settled_residual();
    let powers = order::powers(&Residual {
        left: &left,
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

/// Powers, each the mean of those about it: narrow at the slow waves, where a law of the wrong shape
/// leaves most.
fn smoothed(powers: &[f64]) -> Vec<f64> {
    let mean = |k: usize| {
        let reach = 1 + k / 4;
        let about = &powers[k.saturating_sub(reach)..(k + reach + 1).min(powers.len())];
        about.iter().sum::<f64>() / about.len() as f64
    };
    (0..powers.len()).map(mean).collect()
}
