//! Excess length of the back rope over the drawing: construction stretch, bedding, creep, thermal expansion.
//!
//! The length is added where the rope is attached to the crossbeam: `L_0 + x`.
//!
//! Source: permanent elongation: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "rope_stretch",
        "Length of the back rope: stretch, bedding, thermal expansion",
    )
    .with_location("back_rope", Place::Dynamics)
    .size("length", Unit::Metre, 0.02, [-0.1, 0.1])
    .with_edit(|v, d| d.rod.length += v.get("length"))
}
