//! Deviating inertia of beam and heads, for example from ice: `J (1 + x)`.
//!
//! Source: articulating inertia of a pumping unit: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("beam_inertia", "Inertia of beam and heads")
        .with_location("saddle", Place::Dynamics)
        .size("share", Unit::One, 0.2, [-0.8, 2.0])
        .with_edit(|v, d| d.beam_inertia *= 1.0 + v.get("share"))
}
