//! The motor slips under load and the crank's speed ripples: quasi-statically
//! `w / w_0 = 1 - s_r (T_net - mean) / T_r`.
//!
//! The record is on uniform angle between one mark per revolution, so only what the crank is ahead of
//! uniform rotation matters: `u = c int dphi / (w / w_0)`, with `c` such that a turn stays a turn. The
//! net torque is that of the ideal mechanism, counterweight included.
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks};
use crate::math::spline::Splines;
use crate::model::Machine;
use std::borrow::Cow;
use std::f64::consts::TAU;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("crank_speed_ripple"),
    title: Cow::Borrowed("Ripple of the crank speed by the slip of the motor"),
    joint: "crank",
    place: Place::Drive,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("slip", Unit::One, 0.0267, [0.0, 0.12])]),
    build: Build::Named(|v| Box::new(Ripple { slip: v[0] })),
};

/// Torque at the crank at which slip is stated [N m]: 242 N m of the motor, 28 and 5.21 times. Only the
/// ratio of both acts, so a record knows no torque of its own.
pub(super) const RATED: f64 = 35.3e3;

#[derive(Clone, Copy, Debug)]
struct Ripple {
    /// Slip at [`RATED`] torque \[1\].
    slip: f64,
}

impl Effect for Ripple {
    fn install(&self, machine: &Machine, cycle: &Cycle, hooks: &mut Hooks) {
        let crank = &machine.description.crank;
        let slope = self.slip / RATED;
        let torque =
            |turn| cycle.torque(turn, crank.counterweight_phase, crank.counterweight_moment);
        hooks.warps.push(warp(|turn| slope * torque(turn)));
    }
}

/// Share of the speed that a motor may lose and still turn.
const SLOWEST: f64 = 0.9;

/// Samples of the turn.
const NODES: usize = 720;

/// What the crank is ahead of uniform rotation, over the uniform angle, where its speed is
/// `1 - slow(turn)` up to a constant factor.
pub(super) fn warp(slow: impl Fn(f64) -> f64) -> Splines {
    let step = TAU / NODES as f64;
    let slow: Vec<f64> = (0..NODES).map(|k| slow(step * k as f64)).collect();
    let mean = slow.iter().sum::<f64>() / NODES as f64;
    let lasting: Vec<f64> = slow
        .iter()
        .map(|slow| 1.0 / (1.0 - (slow - mean).min(SLOWEST)))
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

    /// `w = 1 - a cos phi` gives `tan(u / 2) = sqrt((1 + a) / (1 - a)) tan(phi / 2)`.
    #[test]
    fn a_known_ripple_gives_its_lead() {
        let a = 0.02_f64;
        let warp = warp(|turn| a * sin_cos(turn).1);
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
}
