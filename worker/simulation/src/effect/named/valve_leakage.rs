//! Leakage of a pump valve, which changes the load gradually where it should be constant.
//!
//! Leakage of the travelling valve lowers the upper line of the card by a ramp from 40 to 190 deg of turn,
//! back to zero at 210 deg; leakage of the standing valve raises the lower line from 210 to 350 deg, back to
//! zero at 370 deg. The effect covers only leakage that the card does not contain already, as for a card
//! measured on other strokes.
//!
//! Source: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "valve_leakage",
        "Leakage of the travelling or the standing valve",
    )
    .with_location("suspension", Place::Load)
    .size("travelling", Unit::Newton, 2000.0, [0.0, 2e4])
    .size("standing", Unit::Newton, 2000.0, [0.0, 2e4])
    .with_edit(|v, d| {
        let step = 360.0 / d.card.len() as f64;
        for (i, load) in d.card.iter_mut().enumerate() {
            let turn = step * i as f64;
            *load -= v.get("travelling") * ramp(turn, [40.0, 190.0, 210.0]);
            let later = if turn < 100.0 { turn + 360.0 } else { turn };
            *load += v.get("standing") * ramp(later, [210.0, 350.0, 370.0]);
        }
    })
}

/// Computes a triangular function of an angle: 0 at the first of three angles, 1 at the second, 0 again at
/// the third.
fn ramp(turn: f64, [from, top, until]: [f64; 3]) -> f64 {
    if turn < top {
        ((turn - from) / (top - from)).max(0.0)
    } else {
        ((until - turn) / (until - top)).max(0.0)
    }
}
