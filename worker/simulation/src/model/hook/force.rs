//! A generalised force that an effect adds to those of the machine.
use crate::linear::Bordered;
use crate::model::instant::Instant;
use std::fmt::Debug;

/// A generalised force.
pub trait Force: Debug + Send + Sync {
    /// Adds it.
    fn add(&self, at: &Instant<'_>, force: &mut [f64]);

    /// Adds its part of `-K - gamma D`, with `K` and `D` its derivatives by coordinates and rates.
    fn add_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered);

    /// Energy that it stores \[J\].
    fn energy(&self, at: &Instant<'_>) -> f64;

    /// Potential from which it derives at rest and at a fixed time, stored energy included \[J\].
    fn potential(&self, at: &Instant<'_>) -> f64;

    /// Power that it takes out of the machine beyond what it stores \[W\].
    fn lost(&self, at: &Instant<'_>) -> f64;
}
