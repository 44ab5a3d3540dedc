//! Local wear of the back head's surface, a groove or (negative) a weld seam:
//! `h(psi) - depth exp(-((psi - psi_0) / r)^2)`, with `r` such that the hollow is half as deep over
//! `width`.
//!
//! The rope passes the same place twice a turn, winding on and off.
//!
//! Source: the lever arm is geometry; arms of pumping units: Svinos, SPE 12201 (1983).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hollow, Hooks};
use crate::model::Machine;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("head_profile_wear"),
    title: Cow::Borrowed("Local wear of the back head's surface"),
    joint: "back_head",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("depth", Unit::Metre, 0.004, [-0.02, 0.03]),
        Parameter::shape("centre", Unit::Degree, 165.0, [130.0, 215.0]),
        Parameter::shape("width", Unit::Degree, 12.0, [3.0, 40.0]),
    ]),
    build: Build::Named(|v| {
        Box::new(Wear {
            depth: v[0],
            centre: v[1],
            width: v[2],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Wear {
    depth: f64,
    centre: f64,
    width: f64,
}

/// `2 sqrt(ln 2)`: full width at half depth over the distance at which 1/e is left.
const HALF_WIDTH: f64 = 1.665_109_222_315_395_4;

impl Effect for Wear {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.profile.dig(Hollow {
            depth: self.depth,
            centre: self.centre,
            reach: self.width / HALF_WIDTH,
        });
    }
}
