//! The load cell reads a share too little: `F (1 + g)`.
//!
//! Source: static calibration: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("load_cell_gain"),
    title: Cow::Borrowed("Gain of the load cell"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("gain", Unit::One, 0.02, [-0.3, 0.3])]),
    build: Build::Named(|v| Box::new(Gain { gain: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Gain {
    gain: f64,
}

impl Effect for Gain {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        for load in &mut d.card {
            *load *= 1.0 + self.gain;
        }
    }
}
