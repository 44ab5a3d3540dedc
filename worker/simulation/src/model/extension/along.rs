//! Force along a line with its energy and its derivatives for the tangent matrix.

/// Force along a line, positive in the direction of increasing position along the line (the argument `place`
/// of `LineForce::along`), with its energy and derivatives.
///
/// `spring` depends on the position only, and `energy` is its potential. `non_conservative` may depend on the
/// position, its rate and the drive ([`DriveState`](crate::drive::DriveState): turn, rate of the pin, load,
/// time), but **at rest not on the position**: the equilibrium solver treats it as a constant force with the
/// potential `-non_conservative` times the position. Derivatives are required with respect to position and
/// rate; derivatives with respect to drive and time are not needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineForceValue {
    /// Conservative part of the force, which derives from `energy`.
    pub spring: f64,
    /// Part of the force that does not derive from `energy`: friction, or a function of time.
    pub non_conservative: f64,
    /// Energy stored by the conservative part `spring` of the force, that is, its potential.
    pub energy: f64,
    /// Derivative of the total force with respect to the position along the line.
    pub by_place: f64,
    /// Derivative of the total force with respect to the rate of the position along the line.
    pub by_rate: f64,
}
