//! The load cell or its logger lags: `t F_m' + F_m = F`, where the card holds `F_m` and the machine
//! feels `F`.
//!
//! Harmonic `n` of the card is multiplied by `1 + i n w t`. For a negative time the card is the true
//! load and the machine is loaded by a lagged one, `1 / (1 + i n w |t|)`; the two agree to first
//! order. What is restored is noise from some harmonic on: the gain's change fades out as
//! `1 / (1 + (n / 90)^4)`, above the ropes' own modes (orders 60 to 80).
//!
//! Source: first-order instruments: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::math::harmonics::filter;
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("load_cell_lag"),
    title: Cow::Borrowed("First-order lag of the load cell or its logger"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("lag", Unit::Second, 0.15, [-0.5, 0.5])]),
    build: Build::Named(|v| Box::new(Lag { lag: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Lag {
    lag: f64,
}

/// Harmonic at which half of the correction is left.
const FADES: f64 = 90.0;

impl Effect for Lag {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let w = d.crank.speed;
        d.card = filter(&d.card, u32::MAX, |harmonic| {
            let n = f64::from(harmonic);
            let x = n * w * self.lag;
            let fade = n / FADES;
            let left = 1.0 / (1.0 + fade * fade * fade * fade);
            let [re, im] = if self.lag > 0.0 {
                [1.0, x]
            } else {
                let y = 1.0 / (1.0 + x * x);
                [y, x * y]
            };
            [1.0 + left * (re - 1.0), left * im]
        });
    }
}
