//! Deviation of the front head's arc: another radius, or a centre above or below the pivot.
//!
//! A centre lower by `e` makes the lever arm `A + e sin(theta)`, which depends on the sign of the beam angle.
//! The suspension point stays below the arc's foremost point at beam angle 0.
//!
//! Source: the lever arm is geometry; arms of pumping units: Svinos, SPE 12201 (1983).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("front_head_radius", "Radius or centre of the front head")
        .with_location("front_head", Place::Dynamics)
        .size("radius", Unit::Metre, 0.02, [-0.1, 0.1])
        .size("centre", Unit::Metre, 0.02, [-0.1, 0.1])
        .with_edit(|v, d| {
            d.front_arc.radius += v.get("radius");
            d.front_arc.center[1] -= v.get("centre");
        })
}
