//! Whitened residual of a fit, with what is needed to predict its distribution under noise.
use crate::linear::tangent::Tangent;
use nalgebra::DVector;
use record::metric::Metric;

/// Whitened residual of a fit to a record.
#[derive(Clone, Copy, Debug)]
pub struct Residual<'a> {
    /// Whitened residual of the fit, measured less simulated.
    pub values: &'a DVector<f64>,
    /// Metric of the record, in which the residual is whitened.
    pub metric: &'a Metric,
    /// Tangent space of the fit: directions of the residual that recalibration has already removed.
    pub tangent: &'a Tangent,
}
