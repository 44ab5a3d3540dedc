//! Records in units of their own uncertainty, for scoring an answer.
//!
//! Along the directions in which cycles differ from their mean (because their input did) a record is less
//! informative: with `E` the deviations of the mean in these directions, `(I + E E^T)^(-1/2)` is applied to
//! every residual. A variance estimated from few cycles is less certain than it seems: entries are divided by
//! `sqrt(nu / (nu - 2))`, the standard deviation of Student's distribution with `nu` degrees of freedom, at
//! most `sqrt(1.5)`.
use nalgebra::{DMatrix, DVector};
use record::metric::Metric;
use record::noise::NoiseSource;
use record::{Curves, Record};

/// Whitened mean of a record, with the weights that express residuals in units of the record's own
/// uncertainty, for scoring an answer.
#[derive(Clone, Debug)]
pub(crate) struct ScoringMetric {
    metric: Metric,
    /// Factor that converts residuals whitened by the metric into standard deviations of this record's mean,
    /// which may have another number of cycles.
    unit: f64,
    measured: DVector<f64>,
    /// Orthonormal directions in which cycles differ, and the share by which each is shortened.
    shortened: Option<(DMatrix<f64>, DVector<f64>)>,
}

impl ScoringMetric {
    /// Builds the scale of a record from the metric of a mean over `cycles` cycles of the same condition and
    /// channels. `alike` are cycles with the same scatter, from which the shortened directions are estimated.
    pub(crate) fn of(record: &Record, alike: &[Curves], metric: &Metric, cycles: usize) -> Self {
        let unit = (record.cycles.len() as f64 / cycles.max(1) as f64).sqrt();
        let own = record.cycles.len();
        Self {
            measured: metric.whiten(&record.mean()),
            shortened: shortened(metric, alike, unit / (own.max(1) as f64).sqrt()),
            metric: metric.clone(),
            unit,
        }
    }

    /// Returns the residual of the record, measured less simulated, in standard deviations of the record's
    /// mean.
    pub(crate) fn residual(&self, curves: &Curves) -> DVector<f64> {
        let left = &self.measured - self.metric.whiten(curves);
        let weighed = self.weigh(DMatrix::from_columns(&[left]));
        weighed.column(0).into_owned()
    }

    /// Whitens curves in the metric, before [`Self::weigh`].
    pub(crate) fn whiten(&self, curves: &Curves) -> DVector<f64> {
        self.metric.whiten(curves)
    }

    /// Converts whitened columns (residual or Jacobian) into standard deviations of this record's mean:
    /// shortens them in the directions in which cycles differ, and divides them by the factor that widens
    /// variances from few cycles.
    pub(crate) fn weigh(&self, columns: DMatrix<f64>) -> DMatrix<f64> {
        let mut columns = columns * self.unit;
        if let Some((u, lost)) = &self.shortened {
            let mut parts = u.tr_mul(&columns);
            for mut part in parts.column_iter_mut() {
                part.component_mul_assign(lost);
            }
            columns -= u * parts;
        }
        divide_by_student_deviation(&self.metric, columns)
    }

    /// Returns the standard error of the record's mean, by channel.
    pub(crate) fn standard_error(&self) -> Vec<f64> {
        let own = self.metric.standard_error();
        own.into_iter().map(|error| error / self.unit).collect()
    }

    /// Returns the number of entries of a whitened residual.
    pub(crate) fn len(&self) -> usize {
        self.metric.len()
    }

    /// Returns the source of the record's noise: estimated from cycles, stated or guessed.
    pub(crate) const fn known(&self) -> NoiseSource {
        self.metric.known()
    }
}

/// Divides each row of whitened columns by the factor by which its standard deviation is underestimated,
/// given its degrees of freedom.
pub(crate) fn divide_by_student_deviation(
    metric: &Metric,
    mut columns: DMatrix<f64>,
) -> DMatrix<f64> {
    for (mut row, variance) in columns
        .row_iter_mut()
        .zip(metric.student_variances().iter())
    {
        row /= variance.sqrt();
    }
    columns
}

/// Returns the directions in which whitened cycles differ from their mean, and by how much each is shortened;
/// `deviation` converts a deviation of one cycle into that of a record's mean. `None` for fewer than two
/// cycles.
fn shortened(
    metric: &Metric,
    cycles: &[Curves],
    deviation: f64,
) -> Option<(DMatrix<f64>, DVector<f64>)> {
    if cycles.len() < 2 {
        return None;
    }
    let whitened: Vec<DVector<f64>> = cycles.iter().map(|cycle| metric.whiten(cycle)).collect();
    let count = whitened.len() as f64;
    let mean = whitened.iter().sum::<DVector<f64>>() / count;
    let scale = deviation / (count - 1.0).sqrt();
    let each: Vec<DVector<f64>> = whitened.iter().map(|own| (own - &mean) * scale).collect();
    let svd = DMatrix::from_columns(&each).svd(true, false);
    let lost = svd
        .singular_values
        .map(|s| 1.0 - 1.0 / (1.0 + s * s).sqrt());
    svd.u.map(|u| (u, lost))
}
