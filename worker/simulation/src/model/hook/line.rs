//! Forces along one coordinate: `Q = f(d, d', drive)`.
//!
//! Their tangent is a single diagonal entry, and their power and potential are products with the rate and the
//! coordinate.
use super::along::Along;
use super::force::Force;
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::elementary::tanh;
use crate::model::instant::Instant;
use std::fmt::Debug;

/// Force law of one coordinate and its rate; the coordinate is chosen in
/// [`Hooks::on`](super::set::Hooks::on).
pub trait LineForce: Debug + Send + Sync {
    /// Returns the force, positive in the direction of increasing `place`; see [`Along`] for its admissible
    /// dependences.
    fn along(&self, drive: &DriveState, place: f64, rate: f64) -> Along;
}

/// Force law together with the index of the coordinate on which it acts.
#[derive(Debug)]
pub(super) struct OnCoordinate<L> {
    pub(super) coordinate: usize,
    pub(super) law: L,
}

impl<L: LineForce> OnCoordinate<L> {
    fn evaluate(&self, at: &Instant<'_>) -> Along {
        let i = self.coordinate;
        self.law.along(at.drive, at.q[i], at.v[i])
    }
}

impl<L: LineForce> Force for OnCoordinate<L> {
    fn add(&self, at: &Instant<'_>, force: &mut [f64]) {
        let along = self.evaluate(at);
        force[self.coordinate] += along.spring + along.other;
    }

    fn add_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered) {
        let along = self.evaluate(at);
        let i = self.coordinate;
        matrix.add(i, i, -(along.by_place + gamma * along.by_rate));
    }

    fn energy(&self, at: &Instant<'_>) -> f64 {
        self.evaluate(at).energy
    }

    fn potential(&self, at: &Instant<'_>) -> f64 {
        let along = self.evaluate(at);
        along.energy - along.other * at.q[self.coordinate]
    }

    fn lost(&self, at: &Instant<'_>) -> f64 {
        -self.evaluate(at).other * at.v[self.coordinate]
    }
}

/// Viscous damping of one coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Dashpot {
    /// Damping coefficient, force per unit rate.
    pub damping: f64,
}

impl LineForce for Dashpot {
    fn along(&self, _: &DriveState, _: f64, rate: f64) -> Along {
        Along {
            other: -self.damping * rate,
            by_rate: -self.damping,
            ..Along::default()
        }
    }
}

/// Returns the dry friction `-size tanh(rate / regularisation)`, smooth at reversal of the motion: below the
/// regularisation speed it creeps instead of sticking.
pub(crate) fn dry_friction(size: f64, rate: f64, regularisation: f64) -> Along {
    let t = tanh(rate / regularisation);
    Along {
        other: -size * t,
        by_rate: -size * (1.0 - t * t) / regularisation,
        ..Along::default()
    }
}
