//! Lag of the gauges' amplifier or its anti-alias filter: `t s_m' + s_m = s`, periodic.
//!
//! The stress is interpolated linearly between samples, for which the filter's response is exact.
//!
//! Source: first-order instruments: Doebelin, *Measurement Systems*, 5th ed. (2004), chapter 3.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::{exp, powf};
use crate::model::extension::{Effect, Extensions, Reading, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("amplifier_lag", "Lag of the gauges' amplifier")
        .with_location("gauge", Place::Gauge)
        .size("lag", Unit::Second, 0.05, [0.0, 0.5])
        .with_constructor(|v| Lag { lag: v.get("lag") })
}

#[derive(Clone, Copy, Debug)]
struct Lag {
    lag: f64,
}

impl Effect for Lag {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_reading(*self);
    }
}

impl Reading for Lag {
    fn needs_loads(&self) -> bool {
        false
    }

    fn series(&self, spacing: f64, stress: &mut [Vec<f64>; 4]) {
        for curve in stress {
            lagged(curve, spacing / self.lag);
        }
    }
}

/// Applies the first-order lag in place to one period of a curve; `ratio` is the sample spacing divided by
/// the time constant.
fn lagged(curve: &mut [f64], ratio: f64) {
    let kept = exp(-ratio);
    let mixed = (1.0 - kept) / ratio;
    let (from, to) = (mixed - kept, 1.0 - mixed);
    let Some(&last) = curve.last() else { return };
    // answer from rest after one period, then what a period leaves of the start
    let mut answer = 0.0;
    let mut before = last;
    for &now in curve.iter() {
        answer = kept * answer + from * before + to * now;
        before = now;
    }
    answer /= 1.0 - powf(kept, curve.len() as f64);
    before = last;
    for now in curve {
        answer = kept * answer + from * before + to * *now;
        before = *now;
        *now = answer;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::sin_cos;
    use std::f64::consts::TAU;

    /// Checks that `cos(w t)` becomes `(cos(w t) + w tau sin(w t)) / (1 + (w tau)^2)`.
    #[test]
    fn a_wave_lags_as_the_filter_says() {
        let n = 2000;
        for (harmonic, lag) in [(1_u32, 0.05), (7, 0.02), (3, 1e-4)] {
            let angle = |i: usize| TAU * f64::from(harmonic) * i as f64 / n as f64;
            let mut curve: Vec<f64> = (0..n).map(|i| sin_cos(angle(i)).1).collect();
            lagged(&mut curve, TAU / n as f64 / lag);
            let x = f64::from(harmonic) * lag;
            for (i, found) in curve.iter().enumerate() {
                let (s, c) = sin_cos(angle(i));
                let expected = (c + x * s) / (1.0 + x * x);
                assert!((found - expected).abs() < 1e-4, "{harmonic} {lag} {i}");
            }
        }
    }
}
