//! Time shift of the load card: the load at crank angle `phi` is the card's value at `phi + w t`; the motion
//! is unchanged.
//!
//! Source: a card relates load and position at the same moment: Gibbs and Neely, "Computer Diagnosis of
//! Down-Hole Conditions in Sucker Rod Pumping Wells", JPT 18 (1966).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::spline::Splines;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "card_time_shift",
        "Time shift of the load card against the crank",
    )
    .with_location("load_cell", Place::Load)
    .size("time", Unit::Second, 0.1, [-1.0, 1.0])
    .with_edit(|v, d| {
        let step = std::f64::consts::TAU / d.card.len() as f64;
        let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
        // by how much the card is later than the load
        let late = v.get("time") * d.crank.speed;
        for (i, load) in d.card.iter_mut().enumerate() {
            *load = card.value(step * i as f64 + late, 0);
        }
    })
}
