//! Forces that act on a single generalised coordinate: `Q = f(d, d', drive)`.
//!
//! The tangent matrix of such a force is a single diagonal element, its power the product with the
//! coordinate's rate, and its potential the product with the coordinate.
use super::along::LineForceValue;
use super::force::Force;
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::elementary::tanh;
use crate::model::machine_state::MachineState;
use std::fmt::Debug;

/// Force law on one coordinate as a function of its value and rate; the coordinate is chosen in
/// [`Extensions::add_line_force`](super::set::Extensions::add_line_force).
pub trait LineForce: Debug + Send + Sync {
    /// Returns the force on the coordinate, positive in the direction of increasing `place` (the coordinate's
    /// value); [`LineForceValue`] states on what it may depend.
    fn along(&self, drive: &DriveState, place: f64, rate: f64) -> LineForceValue;
}

/// Force law together with the index of the coordinate on which it acts.
#[derive(Debug)]
pub(super) struct OnCoordinate<L> {
    pub(super) coordinate: usize,
    pub(super) law: L,
}

impl<L: LineForce> OnCoordinate<L> {
    fn evaluate(&self, at: &MachineState<'_>) -> LineForceValue {
        let i = self.coordinate;
        self.law.along(at.drive, at.q[i], at.v[i])
    }
}

impl<L: LineForce> Force for OnCoordinate<L> {
    fn add(&self, at: &MachineState<'_>, force: &mut [f64]) {
        let along = self.evaluate(at);
        force[self.coordinate] += along.spring + along.non_conservative;
    }

    fn add_tangent(&self, at: &MachineState<'_>, gamma: f64, matrix: &mut Bordered) {
        let along = self.evaluate(at);
        let i = self.coordinate;
        matrix.add(i, i, -(along.by_place + gamma * along.by_rate));
    }

    fn energy(&self, at: &MachineState<'_>) -> f64 {
        self.evaluate(at).energy
    }

    fn potential(&self, at: &MachineState<'_>) -> f64 {
        let along = self.evaluate(at);
        along.energy - along.non_conservative * at.q[self.coordinate]
    }

    fn lost(&self, at: &MachineState<'_>) -> f64 {
        -self.evaluate(at).non_conservative * at.v[self.coordinate]
    }
}

/// Viscous damping of one coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Dashpot {
    /// Damping coefficient, force per unit rate.
    pub damping: f64,
}

impl LineForce for Dashpot {
    fn along(&self, _: &DriveState, _: f64, rate: f64) -> LineForceValue {
        LineForceValue {
            non_conservative: -self.damping * rate,
            by_rate: -self.damping,
            ..LineForceValue::default()
        }
    }
}

/// Returns the dry friction force `-size tanh(rate / regularisation)`, smooth at reversal of the motion: at
/// rates below `regularisation` the contact creeps instead of sticking.
pub(crate) fn dry_friction(size: f64, rate: f64, regularisation: f64) -> LineForceValue {
    let t = tanh(rate / regularisation);
    LineForceValue {
        non_conservative: -size * t,
        by_rate: -size * (1.0 - t * t) / regularisation,
        ..LineForceValue::default()
    }
}
