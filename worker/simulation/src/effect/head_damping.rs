//! Bolted and welded joints damp the back head's modes more than assumed: `zeta + x`.
//!
//! Source: modal damping: Craig and Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006).
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("head_damping"),
    title: Cow::Borrowed("Structural damping of the back head"),
    joint: "back_head",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("ratio", Unit::One, 0.01, [0.0, 0.2])]),
    build: Build::Named(|v| Box::new(Damping { ratio: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Damping {
    ratio: f64,
}

impl Effect for Damping {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.head.damping_ratio += self.ratio;
    }
}
