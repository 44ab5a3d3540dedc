//! How far a gap closes in the metric of the tests, where every channel counts by its own noise: sharper than
//! mean squares of single channels, and what decides whether a name carries.
//!
//! With whitened residuals `r` before and after, `D = |r_b|^2 - |r_a|^2` is what is closed; under noise of
//! variance 1 its standard deviation is `2 |r_b - r_a|`. Of `|r_b|^2 - n` all could be closed.
use crate::record::measured::{Curves, Record};
use crate::record::metric::Metric;
use crate::record::whitened::WhitenedRecord;
use nalgebra::DVector;
use protocol::job::Numerics;
use serde::Serialize;

/// The share of a gap that closes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Weighed {
    /// Share of what is left above the noise that closes.
    pub closed: f64,
    /// Its 95 % interval.
    #[serde(rename = "ci95")]
    pub interval: [f64; 2],
}

/// A record's mean in a metric.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    metric: Metric,
    /// What a unit of the metric is, in standard deviations of this record's mean.
    unit: f64,
    measured: DVector<f64>,
}

impl Scale {
    /// A record in the metric of the mean of so many cycles of the same condition and channels.
    pub(crate) fn of(record: &Record, metric: &Metric, cycles: usize) -> Self {
        Self {
            unit: (record.cycles.len() as f64 / cycles.max(1) as f64).sqrt(),
            measured: metric.whiten(&record.mean()),
            metric: metric.clone(),
        }
    }

    /// A record under its own noise.
    pub(crate) fn own(record: &Record, highest: usize, numerics: &Numerics) -> Self {
        let own = WhitenedRecord::under_own_noise(record.clone(), highest, numerics.clone());
        Self {
            unit: 1.0,
            measured: own.measured,
            metric: own.metric,
        }
    }

    /// What is left of a record by curves.
    fn left(&self, curves: &Curves) -> DVector<f64> {
        (&self.measured - self.metric.whiten(curves)) * self.unit
    }

    /// How far the gap closes between two models.
    pub(crate) fn weighed(&self, before: &Curves, after: &Curves) -> Weighed {
        /// Normal quantile of a two-sided 95 % interval.
        const QUANTILE: f64 = 1.96;
        let [before, after] = [before, after].map(|curves| self.left(curves));
        let closed = before.norm_squared() - after.norm_squared();
        let half = QUANTILE * 2.0 * (&before - &after).norm();
        let gap = before.norm_squared() - before.len() as f64;
        let whole = gap.max(closed.abs()).max(1.0);
        Weighed {
            closed: closed / whole,
            interval: [(closed - half) / whole, ((closed + half) / whole).min(1.0)],
        }
    }
}
