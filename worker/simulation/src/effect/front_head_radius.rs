//! The front head's arc has another radius, or its centre lies above or below the pivot.
//!
//! A centre lower by `e` makes the arm `A + e sin(theta)`: it differs with the sign of the beam
//! angle. The suspension point stays under the arc's foremost point at beam angle 0.
//!
//! Source: the lever arm is geometry; arms of pumping units: Svinos, SPE 12201 (1983).
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("front_head_radius"),
    title: Cow::Borrowed("Radius or centre of the front head"),
    joint: "front_head",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("radius", Unit::Metre, 0.02, [-0.1, 0.1]),
        Parameter::size("centre", Unit::Metre, 0.02, [-0.1, 0.1]),
    ]),
    build: Build::Named(|v| {
        Box::new(Arc {
            radius: v[0],
            centre: v[1],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Arc {
    radius: f64,
    centre: f64,
}

impl Effect for Arc {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.front_arc.radius += self.radius;
        d.front_arc.center[1] -= self.centre;
    }
}
