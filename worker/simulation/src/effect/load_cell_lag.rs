//! The load cell or its logger lags: `t F_m' + F_m = F`, where the card holds `F_m` and the machine
//! feels `F`.
//!
//! A logger's filter has more than one pole: with `p` of them, of one time constant each, harmonic `n`
//! of the card is multiplied by `(1 + i n w t / p)^p`. `t` is the delay of slow changes, whatever `p`; one
//! pole is a load cell, many are nearly a pure delay. For a negative time the card is the true load and
//! the machine is loaded by a lagged one, `(1 + i n w |t| / p)^-p`; the two agree to first order. What is
//! restored is noise from some harmonic on: the gain's change fades out as `1 / (1 + (n / 90)^4)`, above
//! the ropes' own modes (orders 60 to 80).
//!
//! Source: first-order instruments: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::math::elementary::{atan2, powf, sin_cos};
use crate::math::harmonics::filter;
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("load_cell_lag"),
    title: Cow::Borrowed("Lag of the load cell or its logger"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("lag", Unit::Second, 0.15, [-0.5, 0.5]),
        Parameter::shape("poles", Unit::One, 1.0, [1.0, 4.0]),
    ]),
    build: Build::Named(|v| {
        Box::new(Lag {
            lag: v[0],
            poles: v[1],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Lag {
    lag: f64,
    poles: f64,
}

/// Harmonic at which half of the correction is left.
const FADES: f64 = 90.0;

impl Effect for Lag {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let w = d.crank.speed;
        d.card = filter(&d.card, u32::MAX, |harmonic| {
            let n = f64::from(harmonic);
            let x = n * w * self.lag / self.poles;
            let fade = n / FADES;
            let left = 1.0 / (1.0 + fade * fade * fade * fade);
            let size = powf(1.0 + x * x, 0.5 * self.poles);
            let size = if x > 0.0 { size } else { 1.0 / size };
            let (im, re) = sin_cos(self.poles * atan2(x, 1.0));
            let [re, im] = [size * re, size * im];
            [1.0 + left * (re - 1.0), left * im]
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;
    use std::f64::consts::TAU;

    /// A logger of any number of poles delays a slow wave by its lag and weakens a fast one as it should; the
    /// same lag of the other sign restores it.
    #[test]
    fn what_a_logger_took_is_restored() {
        let n = 720;
        let wave = |h: f64, late: f64| -> Vec<f64> {
            let angle = |i: usize| h * (TAU * i as f64 / n as f64 - late);
            (0..n).map(|i| 1e4 * sin_cos(angle(i)).1).collect()
        };
        for poles in [1.0, 2.0, 3.5] {
            let mut d = reference::description();
            let apply = |lag: f64, d: &mut Description| Lag { lag, poles }.describe(d, &mut 0);
            let lag = 0.02;
            d.card = wave(1.0, 0.0);
            apply(-lag, &mut d);
            let late = wave(1.0, lag * d.crank.speed);
            let apart = |a: &[f64], b: &[f64]| {
                let pairs = a.iter().zip(b);
                pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / 1e4
            };
            assert!(apart(&d.card, &late) < 2e-4, "{poles}");
            let fast = 20.0;
            d.card = wave(fast, 0.0);
            apply(-lag, &mut d);
            let x = fast * lag * d.crank.speed / poles;
            let size = powf(1.0 + x * x, -0.5 * poles);
            let most = d.card.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
            assert!((most / 1e4 - size).abs() < 3e-3, "{most} {size}");
            apply(lag, &mut d);
            assert!(apart(&d.card, &wave(fast, 0.0)) < 5e-3, "{poles}");
        }
    }
}
