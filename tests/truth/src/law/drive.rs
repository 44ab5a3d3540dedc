//! Hidden effects of the drive: the crank angle differs from the recorded one.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use crate::turn::Turn;
use simulation::effect::{Effect, Extensions, Site};
use simulation::math::spline::Splines;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Creates an induction motor after Kloss, `T_m = 2 T_k / (s / s_k + s_k / s)`, that drives a heavy crank: `J
/// dw/dt = T_m - T_net`, integrated over several turns until the speed is periodic.
pub(super) fn kloss(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Motor {
        slip: size,
        rated: record_shape(shape, "rated_torque_n_m", draw.between(33e3, 38e3)),
        breakdown: record_shape(shape, "breakdown_over_rated_1", draw.between(1.9, 2.3)),
        inertia: record_shape(shape, "inertia_kg_m2", draw.between(5e4, 9e4)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Motor {
    /// Slip of the motor at rated torque, as a fraction of synchronous speed \[1\].
    slip: f64,
    /// Rated torque of the motor, referred to the crank [N m].
    rated: f64,
    /// Ratio of the motor's breakdown torque to its rated torque.
    breakdown: f64,
    /// Moment of inertia of motor, gear and cranks, referred to the crank [kg m2].
    inertia: f64,
}

/// Number of time integration steps per crank turn.
const STEPS: usize = 11_520;
/// Number of crank turns that are integrated until the speed is periodic.
const TURNS: usize = 3;
/// Number of samples per turn of the net torque and of the crank's lead.
const NODES: usize = 720;

impl Motor {
    /// Computes the motor torque at a slip [N m].
    fn torque(&self, slip: f64) -> f64 {
        let k = self.breakdown;
        // slip at breakdown, from that at rated torque
        let breakdown = self.slip * (k + (k * k - 1.0).sqrt());
        let s = slip / breakdown;
        2.0 * k * self.rated * s / (1.0 + s * s)
    }

    /// Computes the crank's lead over uniform rotation \[rad\], at equal times over one turn.
    fn lead_angle(&self, speed: f64, net: impl Fn(f64) -> f64) -> Vec<f64> {
        let step = TAU / speed / STEPS as f64;
        let mean = (0..360)
            .map(|k| net(TAU * f64::from(k) / 360.0))
            .sum::<f64>()
            / 360.0;
        // speed without load, such that the mean speed is about the crank's
        let free = speed * (1.0 + self.slip * mean / self.rated);
        let slope = |[turn, rate]: [f64; 2]| {
            let drive = self.torque(1.0 - rate / free);
            [rate, (drive - net(turn)) / self.inertia]
        };
        let mut at = [0.0, speed];
        let mut track = vec![(0.0, 0.0)];
        let mut time = 0.0;
        while at[0] < TAU * TURNS as f64 {
            let moved = |by: f64, k: [f64; 2]| [at[0] + by * k[0], at[1] + by * k[1]];
            let a = slope(at);
            let b = slope(moved(0.5 * step, a));
            let c = slope(moved(0.5 * step, b));
            let d = slope(moved(step, c));
            for i in 0..2 {
                at[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
            time += step;
            track.push((time, at[0]));
        }
        let angle = |wanted: f64| {
            let i = track
                .partition_point(|(time, _)| *time < wanted)
                .clamp(1, track.len() - 1);
            let ((t0, a0), (t1, a1)) = (track[i - 1], track[i]);
            a0 + (a1 - a0) * (wanted - t0) / (t1 - t0)
        };
        let reached = |wanted: f64| {
            let i = track
                .partition_point(|(_, turn)| *turn < wanted)
                .clamp(1, track.len() - 1);
            let ((t0, a0), (t1, a1)) = (track[i - 1], track[i]);
            t0 + (t1 - t0) * (wanted - a0) / (a1 - a0)
        };
        let begin = TAU * (TURNS - 1) as f64;
        let (from, to) = (reached(begin), reached(begin + TAU));
        (0..NODES)
            .map(|k| {
                let share = k as f64 / NODES as f64;
                angle(from + share * (to - from)) - begin - TAU * share
            })
            .collect()
    }
}

impl Effect for Motor {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let crank = site.description.crank;
        let net = |turn: f64| {
            site.cycle
                .torque(turn, crank.counterweight_phase, crank.counterweight_moment)
        };
        let table: Vec<f64> = (0..NODES)
            .map(|k| net(TAU * k as f64 / NODES as f64))
            .collect();
        let net = Splines::periodic(0.0, TAU / NODES as f64, &[table]);
        let ahead = self.lead_angle(crank.speed, |turn| net.value(turn, 0));
        extensions.add_warp(Splines::periodic(0.0, TAU / NODES as f64, &[ahead]));
    }
}

impl HiddenEffect for Motor {}

/// Creates an index pulse error: all channels are recorded at a shifted crank angle.
pub(super) fn late_index(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(LateIndex { angle: size })
}

#[derive(Clone, Copy, Debug)]
struct LateIndex {
    angle: f64,
}

impl Effect for LateIndex {}

impl HiddenEffect for LateIndex {
    fn distort_readings(&self, turn: &mut Turn) {
        turn.shift(self.angle / 360.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Motor = Motor {
        slip: 0.0267,
        rated: 35e3,
        breakdown: 2.1,
        inertia: 5e4,
    };

    #[test]
    fn kloss_goes_through_rated_and_breakdown_torque() {
        assert!((MOTOR.torque(0.0267) - 35e3).abs() < 1e-6);
        let most = (1..400)
            .map(|k| MOTOR.torque(1e-3 * f64::from(k)))
            .fold(0.0, f64::max);
        assert!((most - 2.1 * 35e3).abs() < 10.0);
    }

    /// Checks the quasi-static limit of small slip, `w / w_0 = 1 - s (T - mean) / T_r`: a cosine torque gives
    /// a sine lead; a heavy crank follows a little later.
    #[test]
    fn a_small_slip_gives_the_quasi_static_lead() {
        let motor = Motor {
            slip: 1e-3,
            ..MOTOR
        };
        let ahead = motor.lead_angle(0.5, |turn| 10e3 + 20e3 * libm::cos(turn));
        // its slope is a little higher than at rated torque
        let start = motor.torque(1e-6) / 1e-6;
        for (k, ahead) in ahead.iter().enumerate() {
            let turn = TAU * k as f64 / NODES as f64;
            let expected = -20e3 / start * libm::sin(turn);
            assert!(
                (ahead - expected).abs() < 3e-5,
                "{turn}: {ahead} {expected}"
            );
        }
    }
}
