//! Estimate of the frequency of the beam's swing on its ropes, which time steps must resolve.
use crate::model::RopeMachine;
use crate::system::{Equations, StateRef, System};

/// Estimates the angular frequency of the beam's swing on ropes, contact and head about an equilibrium at
/// time 0 [rad/s].
///
/// The Rayleigh quotient of the machine's deflection under the beam's own inertia, at the cost of one
/// factorisation and one solution. It is higher than the frequency of the lowest mode, which is the pendulum
/// of rod and rope, and represents the mode excited by the load: axial and contact stiffness in series.
///
/// Returns `None` if the tangent is singular or the quotient is not a positive number.
pub fn swing_rate(system: &mut System<RopeMachine<'_>>, q: &[f64]) -> Option<f64> {
    let still = vec![0.0; q.len()];
    let mut deflection = vec![0.0; q.len()];
    let at = StateRef::new(0.0, q, &still);
    let mut loads = system.forces(at, &mut deflection);
    loads.factorize_static(0.0).ok()?;
    let mut unit = still.clone();
    unit[system.equations.machine.layout.beam()] = -1.0;
    deflection.fill(0.0);
    system.equations.subtract_inertia(q, &unit, &mut deflection);
    let inertia = deflection.clone();
    system.solve(&mut deflection);
    let mut momentum = still;
    system
        .equations
        .subtract_inertia(q, &deflection, &mut momentum);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let square = -dot(&inertia, &deflection) / dot(&momentum, &deflection);
    (square > 0.0 && square.is_finite()).then(|| square.sqrt())
}
