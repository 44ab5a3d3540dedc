//! Two ropes of unequal length share the pull unequally: `T / 2 (1 +- e)`, `e = dL EA / (2 T L)`.
//!
//! `EA` and `T` are those of both ropes together, `L` is the back rope's length. The gauges on one
//! cheek (1, 2) feel `1 + e`, those on the other (3, 4) `1 - e`. A rope that is slack carries
//! nothing: `|e| <= 1`.
//!
//! Where a description has twin ropes the length is cut off the back rope at +z instead, and everything
//! follows from the motion.
//!
//! Source: sharing among parallel ropes: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks, Reading, Sampled};
use crate::model::Machine;
use crate::model::description::Description;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("twin_rope_inequality"),
    title: Cow::Borrowed("Unequal lengths of the twin back ropes"),
    joint: "back_rope",
    place: Place::Gauge,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("length", Unit::Metre, 0.002, [-0.05, 0.05])]),
    build: Build::Named(|v| Box::new(Twins { length: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Twins {
    length: f64,
}

impl Effect for Twins {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        if let Some(twins) = &mut d.twins {
            twins.longer[0] += self.length;
        }
    }

    fn install(&self, machine: &Machine, _: &Cycle, hooks: &mut Hooks) {
        if machine.description.twins.is_none() {
            hooks.readings.push(Arc::new(*self));
        }
    }
}

impl Reading for Twins {
    fn sample(&self, at: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
        let rope = &at.individual.machine.description.rope;
        let stiffness = at.individual.ropes.joint.stiffness[0] * rope.pitch;
        let length = rope.back as f64 * rope.pitch;
        let tension: f64 = at.individual.base_tensions(0).sum();
        let difference = 0.5 * self.length * stiffness / length;
        let e = if difference.abs() < tension {
            difference / tension
        } else {
            difference.signum()
        };
        for (stress, side) in stress.iter_mut().zip([e, e, -e, -e]) {
            *stress *= 1.0 + side;
        }
    }
}
