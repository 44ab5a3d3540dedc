//! The load cell's zero is wrong, the beam is out of balance, or a steady wind blows: `F + F_0`.
//!
//! The three have the same shape in the rope's tension to within a few per cent, so they are one
//! effect.
//!
//! Source: zero of the cell: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3; structural
//! unbalance: API Spec 11E.
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("load_offset"),
    title: Cow::Borrowed("Zero of the load cell, unbalance of the beam or steady wind"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("force", Unit::Newton, 1000.0, [-2e4, 2e4])]),
    build: Build::Named(|v| Box::new(Offset { force: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Offset {
    force: f64,
}

impl Effect for Offset {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        for load in &mut d.card {
            *load += self.force;
        }
    }
}
