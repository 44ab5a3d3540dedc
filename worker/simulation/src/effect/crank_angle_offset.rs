//! The record's angle is wrong: `sigma_m(phi) = sigma(phi + d)`, all channels together.
//!
//! Source: angles of a pumping unit: Svinos, "Exact Kinematic Analysis of Pumping Units", SPE 12201
//! (1983).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks};
use crate::model::Machine;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("crank_angle_offset"),
    title: Cow::Borrowed("Zero of the record's crank angle"),
    joint: "crank",
    place: Place::Drive,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("angle", Unit::Degree, 2.0, [-15.0, 15.0])]),
    build: Build::Named(|v| Box::new(Offset { angle: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Offset {
    angle: f64,
}

impl Effect for Offset {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.index_offset += self.angle;
    }
}
