//! The back rope is longer than drawn: construction stretch, bedding, creep, warmth.
//!
//! The length is put where the rope hangs on the crossbeam: `L_0 + x`.
//!
//! Source: permanent elongation: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("rope_stretch"),
    title: Cow::Borrowed("Length of the back rope: stretch, bedding, warmth"),
    joint: "back_rope",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("length", Unit::Metre, 0.02, [-0.1, 0.1])]),
    build: Build::Named(|v| Box::new(Stretch { length: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Stretch {
    length: f64,
}

impl Effect for Stretch {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.rod.length += self.length;
    }
}
