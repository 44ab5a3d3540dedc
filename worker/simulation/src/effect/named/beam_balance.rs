//! Unbalance of beam and heads: a moment of their own weight about the saddle that differs from the
//! description, `M = (M_0 + m) cos(theta)`, positive towards the well.
//!
//! Source: structural unbalance: API Spec 11E, *Pumping Units* (2013); Takacs, *Sucker-Rod Pumping Handbook*
//! (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("beam_balance", "Balance of beam and heads")
        .with_location("saddle", Place::Dynamics)
        .size("moment", Unit::NewtonMetre, 5000.0, [-5e4, 5e4])
        .with_edit(|v, d| d.beam_gravity_moment += v.get("moment"))
}
