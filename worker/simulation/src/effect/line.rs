//! Forces along one coordinate: `Q = f(d, d', t)`.
//!
//! So the tangent is one number on the diagonal, and power and potential are products.
use super::hooks::Force;
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::elementary::tanh;
use crate::model::Instant;
use std::fmt::Debug;

/// A force along a line, and what belongs to it.
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

/// Viscous damping of one coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Dashpot {
    /// Which.
    pub coordinate: usize,
    /// Force per rate.
    pub damping: f64,
}

impl LineForce for Dashpot {
    fn coordinate(&self) -> usize {
        self.coordinate
    }

    fn along(&self, _: &DriveState, _: f64, rate: f64) -> Along {
        Along {
            other: -self.damping * rate,
            by_rate: -self.damping,
            ..Along::default()
        }
    }
}

/// A law of one coordinate and its rate.
pub trait LineForce: Debug + Send + Sync {
    /// Which coordinate.
    fn coordinate(&self) -> usize;

    /// Force, positive where it drives towards growing `place`.
    fn along(&self, drive: &DriveState, place: f64, rate: f64) -> Along;
}

impl<L: LineForce> Force for L {
    fn add(&self, at: &Instant<'_>, force: &mut [f64]) {
        let along = evaluate(self, at);
        force[self.coordinate()] += along.spring + along.other;
    }

    fn add_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered) {
        let along = evaluate(self, at);
        let i = self.coordinate();
        matrix.add(i, i, -(along.by_place + gamma * along.by_rate));
    }

    fn energy(&self, at: &Instant<'_>) -> f64 {
        evaluate(self, at).energy
    }

    fn potential(&self, at: &Instant<'_>) -> f64 {
        let along = evaluate(self, at);
        along.energy - along.other * at.q[self.coordinate()]
    }

    fn lost(&self, at: &Instant<'_>) -> f64 {
        -evaluate(self, at).other * at.v[self.coordinate()]
    }
}

fn evaluate<L: LineForce>(law: &L, at: &Instant<'_>) -> Along {
    let i = law.coordinate();
    law.along(at.drive, at.q[i], at.v[i])
}

/// Dry friction `-size tanh(rate / regularisation)`, smooth where the motion turns: it creeps below
/// the regularisation speed instead of sticking.
pub(super) fn dry_friction(size: f64, rate: f64, regularisation: f64) -> Along {
    let t = tanh(rate / regularisation);
    Along {
        other: -size * t,
        by_rate: -size * (1.0 - t * t) / regularisation,
        ..Along::default()
    }
}
