//! State of an individual's machine at one instant, the argument of every term of the equations of motion.
use crate::drive::DriveState;
use crate::model::ropes::Ropes;

/// State of an individual's machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct MachineState<'a> {
    /// Rope and contact coefficients of the individual.
    pub ropes: &'a Ropes,
    /// State of the machine's drive: crank motion and load.
    pub drive: &'a DriveState,
    /// Generalised coordinates.
    pub q: &'a [f64],
    /// Rates of the generalised coordinates.
    pub v: &'a [f64],
}
