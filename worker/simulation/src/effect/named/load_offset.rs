//! The load cell's zero is wrong, the beam is out of balance, or a steady wind blows: `F + F_0`.
//!
//! The three have the same shape in the rope's tension to within a few per cent, so they are one
//! effect.
//!
//! Source: zero of the cell: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3; structural
//! unbalance: API Spec 11E.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::description::Description;
use crate::model::hook::Effect;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "load_offset",
        "Zero of the load cell, unbalance of the beam or steady wind",
    )
    .at("load_cell", Place::Load)
    .size("force", Unit::Newton, 1000.0, [-2e4, 2e4])
    .builds(|v| Offset {
        force: v.get("force"),
    })
}

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
