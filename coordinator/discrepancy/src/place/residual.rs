//! Whitened residual of a fit, with what is needed to predict its distribution under noise.
use crate::linear::tangent::Tangent;
use crate::record::metric::Metric;
use nalgebra::DVector;

/// A whitened residual.
#[derive(Clone, Copy, Debug)]
pub struct Residual<'a> {
    /// Measured less simulated, one number per entry of the metric.
    pub left: &'a DVector<f64>,
    /// Metric in which the residual is whitened.
    pub metric: &'a Metric,
    /// Tangent space that recalibration has absorbed.
    pub tangent: &'a Tangent,
}
