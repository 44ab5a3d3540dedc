//! Hidden effects of the strain gauges and their amplifiers.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use crate::turn::{Turn, shifted};
use simulation::effect::Effect;
use std::sync::Arc;

/// Draws a relative weight for each gauge: 1 for one of them, random for the others.
fn gauge_weights(draw: &mut RandomStream, shape: &mut Shape) -> [f64; 4] {
    let mut shares = [0.0; 4].map(|_: f64| draw.sign() * draw.between(0.1, 0.9));
    shares[draw.index(4)] = 1.0;
    for (k, share) in shares.iter().enumerate() {
        shape.insert(format!("gauge_{}_share_1", k + 1), *share);
    }
    shares
}

/// Creates a pure time delay of all gauge signals in the amplifiers.
pub(super) fn delay(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Delay { time: size })
}

#[derive(Clone, Copy, Debug)]
struct Delay {
    time: f64,
}

impl Effect for Delay {}

impl HiddenEffect for Delay {
    fn distort_readings(&self, turn: &mut Turn) {
        let behind = self.time / turn.period;
        for curve in &mut turn.stress {
            *curve = shifted(curve, -behind);
        }
    }
}

/// Creates a gain error of each strain gauge, with a slight nonlinearity in the stress.
pub(super) fn gain(size: f64, draw: &mut RandomStream, shape: &mut Shape) -> Arc<dyn HiddenEffect> {
    let bend = record_shape(shape, "per_megapascal_1", draw.between(-2e-4, 2e-4));
    Arc::new(Gain {
        gain: gauge_weights(draw, shape).map(|share| share * size),
        bend,
    })
}

#[derive(Clone, Copy, Debug)]
struct Gain {
    gain: [f64; 4],
    bend: f64,
}

impl Effect for Gain {}

impl HiddenEffect for Gain {
    fn distort_readings(&self, turn: &mut Turn) {
        for (curve, gain) in turn.stress.iter_mut().zip(self.gain) {
            for stress in curve {
                *stress *= 1.0 + gain * (1.0 + self.bend * *stress);
            }
        }
    }
}

/// Creates misaligned gauges, which read part of the partner gauge's component: `s_i cos + s_j sin`.
pub(super) fn rotated(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Rotated {
        into: gauge_weights(draw, shape).map(|share| share * size),
    })
}

#[derive(Clone, Copy, Debug)]
struct Rotated {
    into: [f64; 4],
}

impl Effect for Rotated {}

impl HiddenEffect for Rotated {
    fn distort_readings(&self, turn: &mut Turn) {
        let own = turn.stress.clone();
        for (k, (curve, into)) in turn.stress.iter_mut().zip(self.into).enumerate() {
            let left = (1.0 - into * into).sqrt();
            for ((stress, own), partner) in curve.iter_mut().zip(&own[k]).zip(&own[(k + 2) % 4]) {
                *stress = left * own + into * partner;
            }
        }
    }
}

/// Creates a thermal drift of the gauge zeros, from a cheek heated by the sun: fast at the start of the
/// record and decaying exponentially.
pub(super) fn warming(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Warming {
        turns: record_shape(shape, "time_constant_turns_1", draw.between(4.0, 15.0)),
        rate: gauge_weights(draw, shape).map(|share| share * size),
    })
}

#[derive(Clone, Copy, Debug)]
struct Warming {
    /// Drift rate of each gauge at the start of the record \[MPa per turn\].
    rate: [f64; 4],
    turns: f64,
}

impl Effect for Warming {}

impl HiddenEffect for Warming {
    fn drift(&self, turns: f64) -> [f64; 4] {
        let passed = self.turns * (1.0 - libm::exp(-turns / self.turns));
        self.rate.map(|rate| rate * passed)
    }
}

/// Creates pin clearance with hysteresis: the head's pins lie against one side of their holes and change
/// sides instantly when the rope's force along a drawn direction exceeds a bias by `stick`, or falls below it
/// by `stick` (friction).
pub(super) fn clearance(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    let direction = record_shape(shape, "direction_deg", 10.0 * draw.clamped_normal());
    Arc::new(Clearance {
        direction: [
            libm::cos(direction.to_radians()),
            libm::sin(direction.to_radians()),
        ],
        bias: record_shape(shape, "bias_n", 8e3 * draw.clamped_normal()),
        stick: record_shape(shape, "stick_n", draw.log_between(500.0, 3000.0)),
        step: gauge_weights(draw, shape).map(|share| share * size),
    })
}

#[derive(Clone, Copy, Debug)]
struct Clearance {
    /// Half of each gauge's stress step when the pins change sides \[MPa\].
    step: [f64; 4],
    direction: [f64; 2],
    bias: f64,
    stick: f64,
}

impl Effect for Clearance {}

impl HiddenEffect for Clearance {
    fn distort_readings(&self, turn: &mut Turn) {
        let n = turn.len();
        let mut side = 1.0;
        // the second time round the side at the begin is known
        for k in 0..2 * n {
            let i = k % n;
            let along = turn.push[0][i] * self.direction[0] + turn.push[1][i] * self.direction[1];
            let beyond = along - self.bias;
            if beyond.abs() > self.stick {
                side = beyond.signum();
            }
            if k >= n {
                for (curve, step) in turn.stress.iter_mut().zip(self.step) {
                    curve[i] += step * side;
                }
            }
        }
    }
}

/// Creates two ropes of unequal length under one crossbeam: each carries `T / 2 +- k dL / 2`, zero if slack,
/// and part of each cheek's load is felt by the other cheek.
pub(super) fn twins(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Twins {
        length: size,
        crossing: record_shape(shape, "crossing_1", draw.between(0.0, 0.15)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Twins {
    length: f64,
    /// Share of a cheek's load that the other cheek feels.
    crossing: f64,
}

impl Effect for Twins {}

impl HiddenEffect for Twins {
    fn distort_readings(&self, turn: &mut Turn) {
        let difference = 0.5 * turn.rope * self.length;
        for i in 0..turn.len() {
            let tension = turn.tension[i];
            let uneven = (1.0 - 2.0 * self.crossing) * (difference / tension).clamp(-1.0, 1.0);
            for (curve, side) in turn.stress.iter_mut().zip([1.0, 1.0, -1.0, -1.0]) {
                curve[i] *= 1.0 + side * uneven;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn turn() -> Turn {
        let wave = |phase: f64, size: f64| -> Vec<f64> {
            (0..360)
                .map(|i| size * libm::cos(TAU * f64::from(i) / 360.0 + phase))
                .collect()
        };
        Turn {
            period: 12.0,
            stress: [
                wave(0.0, 10.0),
                wave(1.0, 10.0),
                wave(2.0, 10.0),
                wave(3.0, 10.0),
            ],
            position: wave(0.0, 2.0),
            torque: wave(0.0, 2e4),
            push: [wave(0.0, 5e4), wave(0.5, 5e4)],
            tension: vec![1e5; 360],
            rope: 1e7,
        }
    }

    #[test]
    fn a_delay_makes_a_wave_late() {
        let mut late = turn();
        Delay { time: 0.6 }.distort_readings(&mut late);
        let shifted = TAU * 0.6 / 12.0;
        for (i, stress) in late.stress[0].iter().enumerate() {
            let expected = 10.0 * libm::cos(TAU * i as f64 / 360.0 - shifted);
            assert!((stress - expected).abs() < 1e-5);
        }
        assert_eq!(late.position, turn().position);
    }

    #[test]
    fn pins_change_sides_twice_a_turn_late_by_their_friction() {
        let law = Clearance {
            step: [0.5, 0.0, 0.0, 0.0],
            direction: [1.0, 0.0],
            bias: 0.0,
            stick: 2e3,
        };
        let mut knocked = turn();
        law.distort_readings(&mut knocked);
        let step: Vec<f64> = (0..360)
            .map(|i| knocked.stress[0][i] - turn().stress[0][i])
            .collect();
        let changes: Vec<usize> = (1..360)
            .filter(|i| (step[*i] - step[*i - 1]).abs() > 0.5)
            .collect();
        // cos passes +-0.04 some 2.3 deg after 90 and 270 deg
        assert_eq!(changes, [93, 273]);
        assert!(step.iter().all(|step| (step.abs() - 0.5).abs() < 1e-12));
    }

    #[test]
    fn zeros_run_away_ever_more_slowly() {
        let law = Warming {
            rate: [0.5, -0.2, 0.0, 0.1],
            turns: 5.0,
        };
        let first = law.drift(1.0);
        assert!(first[0] > 0.4 && first[0] < 0.5 && first[1] < 0.0);
        assert!(law.drift(5.0)[0] < 5.0 * first[0]);
    }
}
