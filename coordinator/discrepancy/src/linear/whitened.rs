//! Record with its metric, the reference with which every simulation is compared.
use crate::linear::discrepancy::SmoothBasis;
use crate::linear::waves::smooth_basis;
use nalgebra::DVector;
use protocol::job::Numerics;
use record::basis::ChannelGroup;
use record::metric::Metric;
use record::noise::Noise;
use record::{Curves, Record};
use std::sync::Arc;

/// Record with the metric in which residuals are whitened.
#[derive(Clone, Debug)]
pub struct WhitenedRecord {
    /// Measured record, without held-out cycles.
    pub record: Record,
    /// Metric in which the record's mean and residuals are whitened.
    pub metric: Metric,
    /// Whitened mean over the cycles of the record.
    pub measured: DVector<f64>,
    /// Numerical settings of the simulations that are compared with the record.
    pub numerics: Numerics,
    /// Waves of the smooth discrepancy that fits to the record compete with; `None` where a fit is only a start.
    pub smooth: Option<Arc<SmoothBasis>>,
}

impl WhitenedRecord {
    /// Whitens the mean of a record with a metric.
    pub fn new(record: Record, metric: Metric, numerics: Numerics) -> Self {
        let measured = metric.whiten(&record.mean());
        Self {
            record,
            metric,
            measured,
            numerics,
            smooth: None,
        }
    }

    /// Lets fits to the record compete with a smooth discrepancy.
    #[must_use]
    pub fn with_discrepancy(mut self) -> Self {
        let scales = self.metric.standard_error();
        let whiten = |curves: &Curves| self.metric.whiten(curves);
        self.smooth = Some(Arc::new(smooth_basis(&self.record, scales, whiten)));
        self
    }

    /// Whitens a record with the metric of its own noise, with orders up to `highest` and without errors of
    /// its input.
    pub fn under_own_noise(record: Record, highest: usize, numerics: Numerics) -> Self {
        let groups = ChannelGroup::of(&record, highest, &[]);
        let metric = Metric::new(&groups, &Noise::estimate(&record, &groups, &[]));
        Self::new(record, metric, numerics)
    }

    /// Returns the whitened residual of simulated curves: measured less simulated.
    pub fn residual(&self, curves: &Curves) -> DVector<f64> {
        &self.measured - self.metric.whiten(curves)
    }
}
