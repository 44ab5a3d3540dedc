//! Ripple of the crank speed due to motor slip under load: `J dw/dt = T_m(s) - T_net` with an induction motor
//! by Kloss, `T_m = 2 T_k / (s / s_k + s_k / s)`.
//!
//! Without inertia, `w / w_0 = 1 - s(T_net)` with `s = s_k (T / T_k) / (1 + sqrt(1 - (T / T_k)^2))`; with
//! inertia the crank follows with the time constant `J w_0 s_r / T_r`. The record is sampled at uniform angle
//! between one mark per revolution, so only the lead of the crank over uniform rotation matters: `u = c int
//! dphi / (w / w_0)`, with `c` such that one revolution remains one revolution. The net torque is that of the
//! ideal mechanism, counterweight included.
//!
//! Source: Kloss, "Drehmoment und Schlüpfung des Drehstrommotors", Archiv für Elektrotechnik 5 (1916).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::harmonics::filter;
use crate::math::spline::Splines;
use crate::model::extension::{Effect, Extensions, Site};
use std::f64::consts::TAU;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("crank_speed_ripple", "Ripple of the crank speed by the slip of the motor")
        .with_location("crank", Place::Drive)
        .size("slip", Unit::One, 0.0267, [0.0, 0.12])
        // of a motor of normal design; large: slip in proportion to torque
        .shape("breakdown", Unit::One, 2.1, [1.5, 20.0])
        // a rotor of 1 kg m2 behind 146 : 1, cranks and counterweights
        .shape("inertia", Unit::KilogramSquareMetre, 2.5e4, [0.0, 1e6])
        .with_constructor(|v| Ripple {
            slip: v.get("slip"),
            breakdown: v.get("breakdown"),
            inertia: v.get("inertia"),
        })
}

/// Rated torque at the crank, at which slip is stated [N m]: 242 N m of the motor times the gear ratios 28
/// and 5.21. Only the quotient of slip and rated torque has an influence, so a record does not determine the
/// rated torque.
pub(super) const RATED: f64 = 35.3e3;

#[derive(Clone, Copy, Debug)]
struct Ripple {
    /// Slip of the motor at [`RATED`] torque \[1\].
    slip: f64,
    /// Breakdown torque of the motor divided by [`RATED`] \[1\].
    breakdown: f64,
    /// Moment of inertia of motor, gear and cranks, reduced to the crank [kg m2].
    inertia: f64,
}

/// Limit of the load torque, as a share of the motor's breakdown torque, in the quasi-static motor model.
const MAX_TORQUE_SHARE: f64 = 0.98;

impl Ripple {
    /// Computes the motor's slip at a load torque, on the stable branch of its torque-slip characteristic.
    fn holding(&self, torque: f64) -> f64 {
        let k = self.breakdown;
        let share = (torque / (k * RATED)).clamp(-MAX_TORQUE_SHARE, MAX_TORQUE_SHARE);
        // slip at breakdown, from that at rated torque
        let breakdown = self.slip * (k + (k * k - 1.0).sqrt());
        breakdown * share / (1.0 + (1.0 - share * share).sqrt())
    }

    /// Computes the relative loss of crank speed due to motor slip over one revolution, at [`NODES`] equal
    /// crank angles.
    fn loss(&self, speed: f64, torque: impl Fn(f64) -> f64) -> Vec<f64> {
        let held = sampled(|turn| self.holding(torque(turn)));
        // in turns of the crank
        let lag = speed * speed * self.inertia * self.slip / RATED;
        filter(&held, u32::MAX, |harmonic| {
            let x = f64::from(harmonic) * lag;
            let share = 1.0 / (1.0 + x * x);
            [share, -x * share]
        })
    }
}

impl Effect for Ripple {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let crank = &site.description.crank;
        let torque = |turn| {
            site.cycle
                .torque(turn, crank.counterweight_phase, crank.counterweight_moment)
        };
        extensions.add_warp(warp(&self.loss(crank.speed, torque)));
    }
}

/// Upper limit of the relative deviation of the crank speed from its mean.
const MAX_SPEED_DEVIATION: f64 = 0.9;

/// Number of samples per crank revolution of torque, speed loss and lead.
const NODES: usize = 720;

/// Samples a function of the turn angle at [`NODES`] equal angles.
pub(super) fn sampled(of: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..NODES)
        .map(|k| of(TAU * k as f64 / NODES as f64))
        .collect()
}

/// Computes the lead of the crank over uniform rotation \[rad\], as a function of the uniform angle, for a
/// speed proportional to `1 - slow`; `slow` is sampled at [`NODES`] equal angles.
pub(super) fn warp(slow: &[f64]) -> Splines {
    let step = TAU / NODES as f64;
    let mean = slow.iter().sum::<f64>() / NODES as f64;
    let lasting: Vec<f64> = slow
        .iter()
        .map(|slow| 1.0 / (1.0 - (slow - mean).min(MAX_SPEED_DEVIATION)))
        .collect();
    let whole = lasting.iter().sum::<f64>() / NODES as f64;
    // by the trapezoidal rule: uniform angle less turn, over the turn
    let mut behind = Vec::with_capacity(NODES);
    let mut sum = 0.0;
    for k in 0..NODES {
        behind.push(sum);
        let next = lasting[(k + 1) % NODES];
        sum += step * (0.5 * (lasting[k] + next) / whole - 1.0);
    }
    let behind = Splines::periodic(0.0, step, &[behind]);
    let ahead = (0..NODES).map(|k| {
        let uniform = step * k as f64;
        // turn = uniform - behind(turn): contracts, since the speed changes by some per cent
        let mut turn = uniform;
        for _ in 0..30 {
            turn = uniform - behind.value(turn, 0);
        }
        turn - uniform
    });
    Splines::periodic(0.0, step, &[ahead.collect()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::{atan2, sin_cos};

    /// Checks the computed lead of the crank for the speed `w = 1 - a cos phi` against its closed form `tan(u
    /// / 2) = sqrt((1 + a) / (1 - a)) tan(phi / 2)`.
    #[test]
    fn a_known_ripple_gives_its_lead() {
        let a = 0.02_f64;
        let warp = warp(&sampled(|turn| a * sin_cos(turn).1));
        let uniform = |turn: f64| {
            let (s, c) = sin_cos(0.5 * turn);
            2.0 * atan2((1.0 + a).sqrt() * s, (1.0 - a).sqrt() * c)
        };
        for turn in [0.0, 0.7, 2.0, 3.1] {
            let found = warp.jet(&warp.place(uniform(turn)), 0);
            assert!((found.value - (turn - uniform(turn))).abs() < 1e-6);
            let rate = (1.0 - a * sin_cos(turn).1) / (1.0 - a * a).sqrt();
            assert!((1.0 + found.first - rate).abs() < 1e-5);
        }
    }

    /// Checks that Kloss's formula at the computed slip returns the load torque, and that with a time
    /// constant of 0.25 crank radians the response to a load of the first harmonic lags by `atan 0.25`.
    #[test]
    fn a_motor_holds_its_torque_and_a_heavy_crank_follows() {
        let motor = Ripple {
            slip: 0.03,
            breakdown: 2.1,
            inertia: 0.0,
        };
        let k: f64 = 2.1;
        let at_breakdown = 0.03 * (k + (k * k - 1.0).sqrt());
        for torque in [-50e3, 5e3, RATED, 70e3] {
            let x = motor.holding(torque) / at_breakdown;
            assert!((2.0 * k * RATED / (x + 1.0 / x) - torque).abs() < 1e-6 * RATED);
        }
        assert!((motor.holding(RATED) - 0.03).abs() < 1e-12);
        let speed = 0.5;
        let heavy = Ripple {
            breakdown: 20.0,
            inertia: 0.25 * RATED / (speed * speed * 0.03),
            ..motor
        };
        let wave = |turn: f64| 1e3 * sin_cos(turn).1;
        let loss = heavy.loss(speed, wave);
        let light = heavy.holding(1e3);
        let largest = (0..NODES)
            .max_by(|a, b| loss[*a].total_cmp(&loss[*b]))
            .unwrap();
        let behind = TAU * largest as f64 / NODES as f64;
        assert!((behind - atan2(0.25, 1.0)).abs() < 0.01, "{behind}");
        assert!(loss[largest] < light);
    }
}
