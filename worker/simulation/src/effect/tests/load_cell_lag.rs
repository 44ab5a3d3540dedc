//! Tests of the effect `load_cell_lag` on harmonic loads with a known response.
use crate::effect::catalogue;
use crate::math::elementary::{powf, sin_cos};
use crate::model::description::Description;
use crate::reference;
use std::f64::consts::TAU;

/// Checks that the effect inverts a logger's filter: a load lagged by any number of poles has the predicted
/// delay and attenuation, and the lag of opposite sign restores it.
#[test]
fn what_a_logger_took_is_restored() {
    let known = catalogue().iter().find(|d| d.id == "load_cell_lag");
    let descriptor = known.unwrap();
    let n = 720;
    let wave = |h: f64, late: f64| -> Vec<f64> {
        let angle = |i: usize| h * (TAU * i as f64 / n as f64 - late);
        (0..n).map(|i| 1e4 * sin_cos(angle(i)).1).collect()
    };
    for poles in [1.0, 2.0, 3.5] {
        let mut d = reference::description();
        let apply =
            |lag: f64, d: &mut Description| descriptor.build(&[lag, poles]).describe(d, &mut 0);
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
