//! What a fit leaves, and what tells how noise alone would look there.
use crate::linear::tangent::Tangent;
use crate::record::metric::Metric;
use nalgebra::DVector;

/// A whitened residual.
#[derive(Clone, Copy, Debug)]
pub struct Residual<'a> {
    /// Measured less simulated, one number per entry of the metric.
    pub left: &'a DVector<f64>,
    /// The metric in which it is whitened.
    pub metric: &'a Metric,
    /// What recalibration has absorbed.
    pub tangent: &'a Tangent,
}
