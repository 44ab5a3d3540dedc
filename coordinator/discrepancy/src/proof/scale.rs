//! Records in units of their own uncertainty, where an answer is scored.
//!
//! Along the directions in which cycles differ from their mean (their input did) a record says less: with `E` the
//! deviations of the mean that they show, `(I + E E^T)^(-1/2)` is applied to every residual. A variance that few cycles
//! tell is wider than it seems: entries are divided by `sqrt(nu / (nu - 2))`, the standard deviation of Student's law of
//! `nu` degrees of freedom, at most `sqrt(1.5)`.
use crate::record::measured::{Curves, Record};
use crate::record::metric::Metric;
use crate::record::noise::Known;
use crate::thresholds::WIDEST;
use nalgebra::{DMatrix, DVector};

/// A record's mean in a metric.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    metric: Metric,
    /// What a unit of the metric is, in standard deviations of this record's mean.
    unit: f64,
    measured: DVector<f64>,
    /// Orthonormal directions in which cycles differ, and by how much each is shortened.
    shortened: Option<(DMatrix<f64>, DVector<f64>)>,
}

impl Scale {
    /// A record in the metric of the mean of so many cycles of the same condition and channels; `alike` are
    /// cycles that scatter as its own do: its own, or such as it has no part in.
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

    /// What is left of a record by curves, in standard deviations.
    pub(crate) fn left(&self, curves: &Curves) -> DVector<f64> {
        let left = &self.measured - self.metric.whiten(curves);
        let weighed = self.weigh(DMatrix::from_columns(&[left]));
        weighed.column(0).into_owned()
    }

    /// Curves in the metric, before [`Self::weigh`].
    pub(crate) fn whiten(&self, curves: &Curves) -> DVector<f64> {
        self.metric.whiten(curves)
    }

    /// Columns of the metric in standard deviations of this record's mean, shortened where cycles differ and widened
    /// where few cycles tell how much.
    pub(crate) fn weigh(&self, columns: DMatrix<f64>) -> DMatrix<f64> {
        let mut columns = columns * self.unit;
        if let Some((u, lost)) = &self.shortened {
            let mut parts = u.tr_mul(&columns);
            for mut part in parts.column_iter_mut() {
                part.component_mul_assign(lost);
            }
            columns -= u * parts;
        }
        widened(&self.metric, columns)
    }

    /// How many entries there are.
    pub(crate) fn len(&self) -> usize {
        self.metric.len()
    }

    /// How the record's noise is known.
    pub(crate) const fn known(&self) -> Known {
        self.metric.known()
    }
}

/// Divides the rows of columns by how much wider the entries of a metric are than they seem.
pub(crate) fn widened(metric: &Metric, mut columns: DMatrix<f64>) -> DMatrix<f64> {
    for (mut row, freedom) in columns.row_iter_mut().zip(metric.freedoms().iter()) {
        let variance = if freedom.is_infinite() {
            1.0
        } else if *freedom > 2.0 {
            (freedom / (freedom - 2.0)).min(WIDEST)
        } else {
            WIDEST
        };
        row /= variance.sqrt();
    }
    columns
}

/// The directions in which whitened cycles differ from their mean, `deviation` of each being what it is in a
/// record's mean; nothing of fewer than two.
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
