//! Gain error of the load cell; the true load is `F (1 + g)` where the card states `F`.
//!
//! Source: static calibration: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("load_cell_gain", "Gain of the load cell")
        .with_location("load_cell", Place::Load)
        .size("gain", Unit::One, 0.02, [-0.3, 0.3])
        .with_edit(|v, d| {
            for load in &mut d.card {
                *load *= 1.0 + v.get("gain");
            }
        })
}
