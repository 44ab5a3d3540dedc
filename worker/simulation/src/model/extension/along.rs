//! Force along a line with its energy and its derivatives for the tangent matrix.

/// Force along a line, positive in the direction of increasing `place`, with its energy and derivatives.
///
/// `spring` depends on the place only, and `energy` is its potential. `other` may depend on the place, its
/// rate and the drive ([`DriveState`](crate::drive::DriveState): turn, rate of the pin, load, time), but **at
/// rest not on the place**: the equilibrium solver treats it as a constant force with the potential `-other`
/// times the place. Derivatives are required with respect to place and rate; derivatives with respect to
/// drive and time are not needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineForceValue {
    /// Conservative part of the force, which derives from `energy`.
    pub spring: f64,
    /// Part of the force that does not derive from `energy`: friction, or a function of time.
    pub non_conservative: f64,
    /// Energy stored by the conservative part `spring` of the force, that is, its potential.
    pub energy: f64,
    /// Derivative of the total force with respect to the place along the line.
    pub by_place: f64,
    /// Derivative of the total force with respect to the rate of the place.
    pub by_rate: f64,
}
