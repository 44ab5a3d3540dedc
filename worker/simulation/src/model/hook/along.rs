//! A force along a line with what belongs to it: energy, and derivatives for the tangent.

/// A force along a line, positive where it drives towards growing place, and what belongs to it.
///
/// `spring` is a function of the place alone, and `energy` its potential. `other` may depend on the
/// place, its rate and the drive ([`DriveState`](crate::drive::DriveState): turn, rate of the pin, load,
/// time), but **at rest not on the place**: the search for equilibrium takes it there as a given force,
/// whose potential is `-other` times the place. What depends on place and rate has its derivatives by
/// both stated; derivatives by drive and time are asked by nobody.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Along {
    /// Part that derives from `energy`.
    pub spring: f64,
    /// Part that does not: friction, or a function of time.
    pub other: f64,
    /// Stored energy.
    pub energy: f64,
    /// Derivative of the sum of both parts by the place along the line.
    pub by_place: f64,
    /// The same by its rate.
    pub by_rate: f64,
}
