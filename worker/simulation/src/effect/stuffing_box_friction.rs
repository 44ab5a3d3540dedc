//! Friction of the stuffing box that the load cell does not see: `F - F_s sign(v)` on the suspension
//! point, with `tanh(v / v_0)` for the sign: packing gives before it slides.
//!
//! Source: the law: Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994); packings:
//! Takacs, *Sucker-Rod Pumping Handbook* (2015).
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
    parameters: Cow::Borrowed(&[
        Parameter::size("force", Unit::Newton, 800.0, [0.0, 2e4]),
        // at which three quarters of the friction are there; the stroke reaches 1 m/s
        Parameter::shape("creep", Unit::MetrePerSecond, 5e-3, [1e-3, 0.3]),
    ]),
    build: Build::Named(|v| {
        Box::new(Packing {
            force: v[0],
            creep: v[1],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Packing {
    force: f64,
    creep: f64,
}

impl Effect for Packing {
    fn install(&self, machine: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.forces.push(Arc::new(Line {
            law: *self,
            suspension: machine.layout.suspension(),
        }));
    }
}

#[derive(Clone, Copy, Debug)]
struct Line {
    law: Packing,
    suspension: usize,
}

impl LineForce for Line {
    fn coordinate(&self) -> usize {
        self.suspension
    }

    fn along(&self, _: &DriveState, _: f64, rate: f64) -> Along {
        dry_friction(self.law.force, rate, self.law.creep)
    }
}
