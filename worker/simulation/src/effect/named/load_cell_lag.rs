//! Lag of the load cell or its logger: `t F_m' + F_m = F`, where the card holds `F_m` and `F` acts on the
//! machine.
//!
//! A logger's filter may have several poles: with `p` poles of equal time constant, harmonic `n` of the card
//! is multiplied by `(1 + i n w t / p)^p`. `t` is the delay of slow changes for any `p`; one pole represents
//! a load cell, many are nearly a pure delay. For a negative time the card is the true load and a lagged load
//! acts on the machine, `(1 + i n w |t| / p)^-p`; the two agree to first order. Above some harmonic the
//! restored signal is noise, so the change of gain fades out as `1 / (1 + (n / 90)^4)`, above the ropes' own
//! modes (orders 60 to 80).
//!
//! Source: first-order instruments: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::effect::value::ParameterValues;
use crate::math::elementary::{atan2, powf, sin_cos};
use crate::math::harmonics::filter;
use crate::model::description::Description;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("load_cell_lag", "Lag of the load cell or its logger")
        .with_location("load_cell", Place::Load)
        .size("lag", Unit::Second, 0.15, [-0.5, 0.5])
        .shape("poles", Unit::One, 1.0, [1.0, 4.0])
        .with_edit(lag)
}

/// Order of the crank harmonic at which the fade-out halves the lag correction.
const FADES: f64 = 90.0;

fn lag(v: &ParameterValues, d: &mut Description) {
    let [lag, poles] = v.each(["lag", "poles"]);
    let w = d.crank.speed;
    d.card = filter(&d.card, u32::MAX, |harmonic| {
        let n = f64::from(harmonic);
        let x = n * w * lag / poles;
        let fade = n / FADES;
        let left = 1.0 / (1.0 + fade * fade * fade * fade);
        let size = powf(1.0 + x * x, 0.5 * poles);
        let size = if x > 0.0 { size } else { 1.0 / size };
        let (im, re) = sin_cos(poles * atan2(x, 1.0));
        let [re, im] = [size * re, size * im];
        [1.0 + left * (re - 1.0), left * im]
    });
}
