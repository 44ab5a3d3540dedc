//! Bolted and welded joints damp the back head's modes more than assumed: `zeta + x`.
//!
//! Source: modal damping: Craig and Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::description::Description;
use crate::model::hook::Effect;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("head_damping", "Structural damping of the back head")
        .at("back_head", Place::Dynamics)
        .size("ratio", Unit::One, 0.01, [0.0, 0.2])
        .builds(|v| Damping {
            ratio: v.get("ratio"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Damping {
    ratio: f64,
}

impl Effect for Damping {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.head.damping_ratio += self.ratio;
    }
}
