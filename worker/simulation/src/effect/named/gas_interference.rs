//! Gas interference: gas in the pump must be compressed before the travelling valve opens, so that the load
//! falls later and more gradually, `F(phi) -> F(phi - d(phi))`.
//!
//! The delay starts at top dead centre, is greatest 60 deg later and ends after 120 deg: `d = d_0 sin^2(pi
//! (phi - phi_top) / 120 deg)`.
//!
//! Source: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::effect::value::ParameterValues;
use crate::math::elementary::sin_cos;
use crate::math::spline::Splines;
use crate::model::cycle::Cycle;
use crate::model::description::Description;
use std::f64::consts::{PI, TAU};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("gas_interference", "Gas interference in the pump")
        .with_location("suspension", Place::Load)
        .size("delay", Unit::Degree, 12.0, [0.0, 35.0])
        .with_edit(late)
}

/// Range of crank angle after top dead centre in which gas compression delays the load \[rad\].
const LATE: f64 = 120.0 * PI / 180.0;

fn late(v: &ParameterValues, d: &mut Description) {
    // a mechanism that does not close is refused when the machine is built
    let Ok(cycle) = Cycle::of(d) else { return };
    let top = cycle.turn_at_descent(0.0);
    let step = TAU / d.card.len() as f64;
    let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
    for (i, load) in d.card.iter_mut().enumerate() {
        let turn = step * i as f64;
        let since = turn - top;
        if since > 0.0 && since < LATE {
            let (s, _) = sin_cos(PI * since / LATE);
            *load = card.value(turn - v.get("delay") * s * s, 0);
        }
    }
}
