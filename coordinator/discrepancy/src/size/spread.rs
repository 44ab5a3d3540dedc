//! How far a record leaves the unknowns of a fit open: their covariance, and the quantile of their intervals.
//!
//! With the Jacobian `J` of the whitened residual and the precision `L` of what is known beforehand, the covariance is
//! `(J^T J / s^2 + L)^-1`, where `s^2 = chi^2 / (n - p)` is the dispersion: the textbook's for least squares. It is at
//! least 1 where the noise was seen or stated, for then its variance is known.
//!
//! What is left may be coloured: a law of the wrong shape leaves slow waves, and unknowns that act slowly are known less
//! well than as many independent entries would have it. With the power `S` of the residual, wave by wave, the covariance
//! is the sandwich `A^-1 (J^T S J / s^4 + L) A^-1`, `A = J^T J / s^2 + L` (White 1980; in waves a stationary error is
//! independent, so that its autocovariance needs no estimate). No variance falls below the one for white residuals.
use crate::linear::score::student;
use crate::linear::tangent::free;
use crate::model::fit::Fit;
use crate::place::residual::Residual;
use crate::place::{order, whiteness};
use crate::record::metric::Metric;
use crate::record::noise::Known;
use crate::record::spectrum::Spectra;
use crate::thresholds::COLOURED;
use nalgebra::{DMatrix, DVector};

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
        let jacobian = &fit.search.best().jacobian;
        let information = jacobian.tr_mul(jacobian) / dispersion;
        let prior = DMatrix::from_diagonal(&precisions(fit));
        let unit = DVector::from_element(fit.x().len(), 1.0);
        let white = (&information + &prior).cholesky().map(|a| a.inverse());
        let coloured = meat(metric, fit, dispersion);
        let (covariance, growth) = match (white, coloured) {
            (Some(white), Some(meat)) => {
                let wide = &white * (meat / (dispersion * dispersion) + prior) * &white;
                let growth = DVector::from_fn(unit.len(), |k, _| {
                    (wide[(k, k)] / white[(k, k)]).max(1.0).sqrt()
                });
                // correlations of the sandwich, variances of whichever is wider
                let scale = DVector::from_fn(unit.len(), |k, _| {
                    (white[(k, k)] / wide[(k, k)]).max(1.0).sqrt()
                });
                let wide = DMatrix::from_fn(unit.len(), unit.len(), |i, j| {
                    wide[(i, j)] * scale[i] * scale[j]
                });
                (Some(wide), growth)
            }
            (white, _) => (white, unit),
        };
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

/// Precisions of what is known of a fit's unknowns beforehand.
fn precisions(fit: &Fit) -> DVector<f64> {
    let each = fit.variables().iter();
    let each = each.map(|v| v.prior.map_or(0.0, |p| 1.0 / (p.deviation * p.deviation)));
    DVector::from_iterator(fit.x().len(), each)
}

/// `J^T S J` with the power of what a fit leaves, wave by wave; none where that is white.
fn meat(metric: &Metric, fit: &Fit, dispersion: f64) -> Option<DMatrix<f64>> {
    let powers = order::powers(&Residual {
        left: &fit.search.settled_residual(),
        metric,
        tangent: &fit.tangent(),
    });
    if whiteness::p_value(&powers, metric.freedom()) >= COLOURED {
        return None;
    }
    let levels: Vec<Vec<f64>> = powers.iter().map(|row| smoothed(row)).collect();
    let jacobian = &fit.search.best().jacobian;
    let used = free(fit.search.best(), fit.variables());
    let waves: Vec<Spectra> = used
        .iter()
        .map(|&k| metric.waves(&jacobian.column(k).into_owned()))
        .collect();
    let count = fit.x().len();
    // what lies in no wave counts by the dispersion
    let mut meat = jacobian.tr_mul(jacobian) * dispersion;
    for (i, a) in used.iter().zip(&waves) {
        for (j, b) in used.iter().zip(&waves) {
            let channels = a.iter().zip(b).zip(&levels);
            let excess = channels.map(|((a, b), levels)| {
                let each = a.iter().zip(b).zip(levels);
                each.map(|((a, b), level)| (level - dispersion) * (a.conj() * b).re)
                    .sum::<f64>()
            });
            meat[(*i, *j)] += excess.sum::<f64>();
        }
    }
    debug_assert_eq!(meat.nrows(), count);
    Some(meat)
}

/// Powers over those of noise, each the mean of those about it: narrow at the slow waves, where a law of the wrong shape
/// leaves most.
fn smoothed(powers: &[f64]) -> Vec<f64> {
    let mean = |k: usize| {
        let reach = 1 + k / 4;
        let about = &powers[k.saturating_sub(reach)..(k + reach + 1).min(powers.len())];
        about.iter().sum::<f64>() / about.len() as f64
    };
    (0..powers.len()).map(mean).collect()
}
