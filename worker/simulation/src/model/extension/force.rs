//! Interface of a generalised force that an effect adds to those of the machine.
use crate::linear::Bordered;
use crate::model::machine_state::MachineState;
use std::fmt::Debug;

/// Generalised force that an effect adds to the equations of motion.
pub trait Force: Debug + Send + Sync {
    /// Adds the generalised force at the instant `at` to `force`, one element per coordinate.
    fn add(&self, at: &MachineState<'_>, force: &mut [f64]);

    /// Adds the force's contribution to `-K - gamma D`, where `K` and `D` are its derivatives with respect to
    /// coordinates and rates.
    fn add_tangent(&self, at: &MachineState<'_>, gamma: f64, matrix: &mut Bordered);

    /// Returns the stored energy of the force \[J\].
    fn energy(&self, at: &MachineState<'_>) -> f64;

    /// Returns the potential from which the force derives at rest and at a fixed time, including the stored
    /// energy \[J\].
    fn potential(&self, at: &MachineState<'_>) -> f64;

    /// Returns the power that the force extracts from the machine \[W\], not counting energy that it stores.
    fn lost(&self, at: &MachineState<'_>) -> f64;
}
