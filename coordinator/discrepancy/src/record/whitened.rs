//! A record in the metric in which it counts: what every simulation is compared with.
use crate::record::basis::Group;
use crate::record::measured::{Curves, Record};
use crate::record::metric::Metric;
use crate::record::noise::Noise;
use nalgebra::DVector;
use protocol::job::Numerics;

/// A record under a metric.
#[derive(Clone, Debug)]
pub struct WhitenedRecord {
    /// What was measured, calibration cycles only.
    pub record: Record,
    /// Its metric.
    pub metric: Metric,
    /// The whitened mean of the record.
    pub measured: DVector<f64>,
    /// How models are computed that are compared with it.
    pub numerics: Numerics,
}

impl WhitenedRecord {
    /// Joins a record and a metric.
    pub fn new(record: Record, metric: Metric, numerics: Numerics) -> Self {
        let measured = metric.whiten(&record.mean());
        Self {
            record,
            metric,
            measured,
            numerics,
        }
    }

    /// A record under a metric of its own noise up to an order, without errors of its inputs.
    pub fn under_own_noise(record: Record, highest: usize, numerics: Numerics) -> Self {
        let groups = Group::of(&record, highest, &[]);
        let metric = Metric::new(&groups, &Noise::estimate(&record, &groups, &[]));
        Self::new(record, metric, numerics)
    }

    /// Residual of simulated curves: measured less simulated, whitened.
    pub fn residual(&self, curves: &Curves) -> DVector<f64> {
        &self.measured - self.metric.whiten(curves)
    }
}
