//! Fluid pound from incomplete pump fillage: on the downstroke the plunger carries the load until it meets
//! the liquid.
//!
//! From top dead centre the load keeps its value there, by the share `held`, until the suspension point has
//! descended by `1 - fillage` of its stroke; there it falls to the card's value within `fall` degrees. The
//! impact, `dF = Z v`, rings in the rods: `-impact sin(w t) exp(-t / 3 s)` from then on.
//!
//! Source: Takacs, *Sucker-Rod Pumping Handbook* (2015); the impact's wave: Gibbs, JPT 15 (1963).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::effect::value::ParameterValues;
use crate::math::elementary::{exp, sin_cos};
use crate::math::spline::Splines;
use crate::model::cycle::Cycle;
use crate::model::description::Description;
use std::f64::consts::TAU;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "fluid_pound",
        "Fluid pound: the pump does not fill completely",
    )
    .with_location("suspension", Place::Load)
    .size("held", Unit::One, 1.0, [0.0, 1.5])
    .size("impact", Unit::Newton, 3000.0, [0.0, 3e4])
    .shape("fillage", Unit::One, 0.85, [0.3, 0.99])
    .shape("fall", Unit::Degree, 8.0, [1.0, 60.0])
    .shape("frequency", Unit::Hertz, 0.739, [0.2, 3.0])
    .with_edit(pound)
}

/// Time constant with which the ringing after the plunger's impact decays \[s\].
const DECAY: f64 = 3.0;

fn pound(v: &ParameterValues, d: &mut Description) {
    let [held, impact] = v.each(["held", "impact"]);
    let [fillage, fall, frequency] = v.each(["fillage", "fall", "frequency"]);
    // a mechanism that does not close is refused when the machine is built
    let Ok(cycle) = Cycle::of(d) else { return };
    let (top, blow) = (
        cycle.turn_at_descent(0.0),
        cycle.turn_at_descent(1.0 - fillage),
    );
    let n = d.card.len();
    let step = TAU / n as f64;
    let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
    let full = card.value(top, 0);
    for (i, load) in d.card.iter_mut().enumerate() {
        let turn = step * i as f64;
        if turn > top {
            let u = ((turn - blow) / fall).clamp(0.0, 1.0);
            let holding = 1.0 - u * u * (3.0 - 2.0 * u);
            *load += held * holding * (full - *load);
        }
        for earlier in 0..3 {
            let t = (turn - blow + TAU * f64::from(earlier)) / d.crank.speed;
            if t > 0.0 {
                let (s, _) = sin_cos(TAU * frequency * t);
                *load -= impact * s * exp(-t / DECAY);
            }
        }
    }
}
