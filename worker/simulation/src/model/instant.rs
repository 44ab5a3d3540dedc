//! An individual's machine at one instant: what every term of the equations is asked with.
use crate::drive::DriveState;
use crate::model::ropes::Ropes;

/// An individual's machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// The individual's ropes.
    pub ropes: &'a Ropes,
    /// Crank and load.
    pub drive: &'a DriveState,
    /// Coordinates.
    pub q: &'a [f64],
    /// Their rates.
    pub v: &'a [f64],
}
