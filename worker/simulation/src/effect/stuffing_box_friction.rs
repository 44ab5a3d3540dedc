//! Friction of the stuffing box that the load cell does not see: `F - F_s sign(v)` on the suspension
//! point, with `tanh(v / v_0)` for the sign.
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::line::dry_friction;
use super::{Along, Cycle, Effect, Hooks, LineForce};
use crate::drive::DriveState;
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("stuffing_box_friction"),
    title: Cow::Borrowed("Friction of the stuffing box that the load cell does not see"),
    joint: "suspension",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("force", Unit::Newton, 800.0, [0.0, 2e4])]),
    build: Build::Named(|v| Box::new(Packing { force: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Packing {
    force: f64,
}

/// Speed \[m/s\] at which three quarters of the friction are there; the stroke reaches 1 m/s.
const CREEP: f64 = 5e-3;

impl Effect for Packing {
    fn install(&self, machine: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.forces.push(Arc::new(Line {
            force: self.force,
            suspension: machine.layout.suspension(),
        }));
    }
}

#[derive(Clone, Copy, Debug)]
struct Line {
    force: f64,
    suspension: usize,
}

impl LineForce for Line {
    fn coordinate(&self) -> usize {
        self.suspension
    }

    fn along(&self, _: &DriveState, _: f64, rate: f64) -> Along {
        dry_friction(self.force, rate, CREEP)
    }
}
