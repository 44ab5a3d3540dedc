//! The front rope loses power where it winds on and off the front head: `M = e T A sign(theta')`.
//!
//! The tension is that of the load alone, from the card and the ideal motion. The rope always leaves
//! the arc at the height of its centre, so it winds as the beam turns.
//!
//! Source: efficiency of ropes over sheaves: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::line::dry_friction;
use super::{Along, Cycle, Effect, Hooks, LineForce};
use crate::drive::DriveState;
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("front_rope_bending_loss"),
    title: Cow::Borrowed("Bending loss of the front rope on its head"),
    joint: "front_rope",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("loss", Unit::One, 0.005, [0.0, 0.1]),
        // at which three quarters of the loss are there; the beam reaches 0.3 rad/s
        Parameter::shape("creep", Unit::RadianPerSecond, 2e-3, [5e-4, 0.1]),
    ]),
    build: Build::Named(|v| {
        Box::new(Loss {
            loss: v[0],
            creep: v[1],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Loss {
    loss: f64,
    creep: f64,
}

impl Effect for Loss {
    fn install(&self, machine: &Machine, _: &Cycle, hooks: &mut Hooks) {
        let d = &machine.description;
        hooks.forces.push(Arc::new(Line {
            arm: self.loss * d.front_arc.radius,
            creep: self.creep,
            weight: d.suspension_mass * d.gravity,
            beam: machine.layout.beam(),
        }));
    }
}

#[derive(Clone, Copy, Debug)]
struct Line {
    arm: f64,
    creep: f64,
    weight: f64,
    beam: usize,
}

impl LineForce for Line {
    fn coordinate(&self) -> usize {
        self.beam
    }

    fn along(&self, drive: &DriveState, _: f64, rate: f64) -> Along {
        dry_friction(self.arm * (drive.load + self.weight), rate, self.creep)
    }
}
