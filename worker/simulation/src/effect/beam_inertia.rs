//! Another inertia of beam and heads, or ice on them: `J (1 + x)`.
//!
//! Source: articulating inertia of a pumping unit: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("beam_inertia"),
    title: Cow::Borrowed("Inertia of beam and heads"),
    joint: "saddle",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("share", Unit::One, 0.2, [-0.8, 2.0])]),
    build: Build::Named(|v| Box::new(Inertia { share: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Inertia {
    share: f64,
}

impl Effect for Inertia {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.beam_inertia *= 1.0 + self.share;
    }
}
