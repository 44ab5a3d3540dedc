//! A pump valve leaks: the load slips away while it should stay.
//!
//! Where the travelling valve leaks, the upper line falls by a ramp from 40 to 190 deg of turn, and is
//! back at 210 deg; where the standing valve leaks, the lower line rises from 210 to 350 deg and is
//! back at 370 deg. Only what the card does not know already counts, if it was not measured on the
//! same strokes.
//!
//! Source: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "valve_leakage",
        "Leakage of the travelling or the standing valve",
    )
    .at("suspension", Place::Load)
    .size("travelling", Unit::Newton, 2000.0, [0.0, 2e4])
    .size("standing", Unit::Newton, 2000.0, [0.0, 2e4])
    .edits(|v, d| {
        let step = 360.0 / d.card.len() as f64;
        for (i, load) in d.card.iter_mut().enumerate() {
            let turn = step * i as f64;
            *load -= v.get("travelling") * ramp(turn, [40.0, 190.0, 210.0]);
            let later = if turn < 100.0 { turn + 360.0 } else { turn };
            *load += v.get("standing") * ramp(later, [210.0, 350.0, 370.0]);
        }
    })
}

/// From 0 at the first angle to 1 at the second and back to 0 at the third.
fn ramp(turn: f64, [from, top, until]: [f64; 3]) -> f64 {
    if turn < top {
        ((turn - from) / (top - from)).max(0.0)
    } else {
        ((until - turn) / (until - top)).max(0.0)
    }
}
