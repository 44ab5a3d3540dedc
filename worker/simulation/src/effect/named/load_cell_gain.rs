//! The load cell reads a share too little: `F (1 + g)`.
//!
//! Source: static calibration: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::description::Description;
use crate::model::hook::Effect;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("load_cell_gain", "Gain of the load cell")
        .at("load_cell", Place::Load)
        .size("gain", Unit::One, 0.02, [-0.3, 0.3])
        .builds(|v| Gain {
            gain: v.get("gain"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Gain {
    gain: f64,
}

impl Effect for Gain {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        for load in &mut d.card {
            *load *= 1.0 + self.gain;
        }
    }
}
