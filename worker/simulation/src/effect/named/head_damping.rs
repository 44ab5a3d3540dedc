//! Additional damping of the back head's modes by bolted and welded joints: `zeta + x`.
//!
//! Source: modal damping: Craig and Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("head_damping", "Structural damping of the back head")
        .with_location("back_head", Place::Dynamics)
        .size("ratio", Unit::One, 0.01, [0.0, 0.2])
        .with_edit(|v, d| d.head.damping_ratio += v.get("ratio"))
}
