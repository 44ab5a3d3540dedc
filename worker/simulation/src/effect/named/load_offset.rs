//! Load offset, from the zero of the load cell, unbalance of the beam or steady wind: `F + F_0`.
//!
//! The three causes have the same shape in the rope's tension to within a few per cent, so they are one
//! effect.
//!
//! Source: zero of the cell: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3; structural
//! unbalance: API Spec 11E.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "load_offset",
        "Zero of the load cell, unbalance of the beam or steady wind",
    )
    .with_location("load_cell", Place::Load)
    .size("force", Unit::Newton, 1000.0, [-2e4, 2e4])
    .with_edit(|v, d| {
        for load in &mut d.card {
            *load += v.get("force");
        }
    })
}
