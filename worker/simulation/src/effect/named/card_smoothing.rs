//! Restoration of what smoothing removed from the load card before delivery: the rod string's own vibrations.
//!
//! Two corrections are available. Harmonics of the card's load `F` above a given number are amplified by a
//! share `x`: `F + x (F - F_kept)`, where `F_kept` has only the lower harmonics; -1 removes the upper ones.
//! Where none are left to amplify, the rod string itself rings after each load transfer, at its fundamental
//! `a / 4 L` and decaying: `+- (A sin w t + B cos w t (1 - exp(-t / 0.1 s))) exp(-c t)` after the steepest
//! rise (+) and the steepest fall (-) of the smoothed card. Sine and cosine together represent any phase.
//!
//! Source: a smoothed card loses the rod string's reflections: Gibbs, "Predicting the Behavior of Sucker-Rod
//! Pumping Systems", JPT 15 (1963).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::{exp, sin_cos};
use crate::math::harmonics::low_pass;
use crate::model::description::Description;
use crate::model::extension::Effect;
use std::f64::consts::TAU;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "card_smoothing",
        "Rod-string vibrations removed from the card by smoothing",
    )
    .with_location("load_cell", Place::Load)
    .size("restored", Unit::One, 0.5, [-1.0, 5.0])
    .size("ring_sine", Unit::Newton, 1500.0, [-2e4, 2e4])
    .size("ring_cosine", Unit::Newton, 1500.0, [-2e4, 2e4])
    .shape("harmonics", Unit::One, 8.0, [3.0, 60.0])
    .whole()
    .shape("frequency", Unit::Hertz, 0.739, [0.2, 3.0])
    .shape("decay", Unit::PerSecond, 0.3, [0.05, 3.0])
    .with_constructor(|v| Smoothing {
        restored: v.get("restored"),
        ring: v.each(["ring_sine", "ring_cosine"]),
        harmonics: v.get("harmonics"),
        frequency: v.get("frequency"),
        decay: v.get("decay"),
    })
}

#[derive(Clone, Copy, Debug)]
struct Smoothing {
    restored: f64,
    ring: [f64; 2],
    harmonics: f64,
    frequency: f64,
    decay: f64,
}

/// Time constant with which the cosine part of the rod string's ringing sets in \[s\].
const ONSET: f64 = 0.1;

/// Number of crank revolutions, including the current one, whose load transfers still contribute ringing.
const EARLIER: u32 = 6;

impl Effect for Smoothing {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of harmonics within its bounds"
        )]
        let kept = low_pass(&d.card, self.harmonics.round() as u32);
        let n = kept.len();
        let slope = |i: usize| kept[(i + 1) % n] - kept[(i + n - 1) % n];
        let steepest = |sign: f64| {
            (0..n).fold(0, |best, i| {
                if sign * slope(i) > sign * slope(best) {
                    i
                } else {
                    best
                }
            })
        };
        let (rise, fall) = (steepest(1.0), steepest(-1.0));
        let step = TAU / n as f64 / d.crank.speed;
        for (i, load) in d.card.iter_mut().enumerate() {
            let since = |event: usize| ((i + n - event) % n) as f64 * step;
            *load += self.restored * (*load - kept[i]);
            *load += self.ringing(since(rise), step * n as f64);
            *load -= self.ringing(since(fall), step * n as f64);
        }
    }
}

impl Smoothing {
    /// Computes the load that the rod string's ringing adds \[N\], at a time \[s\] after a load rise that
    /// recurs with a given period \[s\].
    fn ringing(&self, since: f64, period: f64) -> f64 {
        let mut sum = 0.0;
        for earlier in 0..EARLIER {
            let t = since + period * f64::from(earlier);
            let (s, c) = sin_cos(TAU * self.frequency * t);
            let onset = 1.0 - exp(-t / ONSET);
            sum += exp(-self.decay * t) * (self.ring[0] * s + self.ring[1] * c * onset);
        }
        sum
    }
}
