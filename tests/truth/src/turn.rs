//! Curves of one crank revolution as ideal sensors would record them, sampled at equal time intervals.
use simulation::math::spline::Splines;
use simulation::model::description::RopeLaw;
use simulation::model::{Machine, RopeMachine};
use simulation::observe::Recorder;
use simulation::run::Observe;
use simulation::system::State;
use simulation::system::System;

/// Curves of gauge stress, position, torque and back-rope forces over one crank revolution, sampled at equal
/// time intervals from crank turn angle 0; periodic, so the first sample also follows the last.
#[derive(Clone, Debug, Default)]
pub struct Turn {
    /// Duration of the revolution \[s\].
    pub period: f64,
    /// Stress at gauges 1 to 4 \[MPa\].
    pub stress: [Vec<f64>; 4],
    /// Height of the suspension point above its lowest position by design \[m\].
    pub position: Vec<f64>,
    /// Net torque at the crank [N m].
    pub torque: Vec<f64>,
    /// Components of the back rope's force on the back head, along and across the beam \[N\].
    pub push: [Vec<f64>; 2],
    /// Tension of the back rope at the crossbeam \[N\].
    pub tension: Vec<f64>,
    /// Stiffness of the whole back rope [N/m].
    pub rope: f64,
}

impl Turn {
    /// Number of samples per curve.
    pub fn len(&self) -> usize {
        self.tension.len()
    }

    /// Whether the curves have no samples.
    pub fn is_empty(&self) -> bool {
        self.tension.is_empty()
    }

    /// Returns the curves that a record contains: stress at gauges 1 to 4, position, torque.
    pub fn recorded(&self) -> Vec<Vec<f64>> {
        let mut channels = self.stress.to_vec();
        channels.push(self.position.clone());
        channels.push(self.torque.clone());
        channels
    }

    /// Replaces every curve by its values at later times, shifted by the share `ahead` of the revolution.
    pub fn shift(&mut self, ahead: f64) {
        let all = self.stress.iter_mut().chain(&mut self.push);
        let others = [&mut self.position, &mut self.torque, &mut self.tension];
        for curve in all.chain(others) {
            *curve = shifted(curve, ahead);
        }
    }
}

/// Returns the values of a periodic curve at later times, shifted by the share `ahead` of its period, by
/// spline interpolation.
pub fn shifted(curve: &[f64], ahead: f64) -> Vec<f64> {
    let n = curve.len() as f64;
    let spline = Splines::periodic(0.0, 1.0, &[curve.to_vec()]);
    (0..curve.len())
        .map(|i| spline.value(i as f64 + ahead * n, 0))
        .collect()
}

/// Observer of a simulation that samples the curves of a [`Turn`].
#[derive(Debug, Default)]
pub struct Watch {
    recorder: Recorder,
    push: [Vec<f64>; 2],
}

impl Watch {
    /// Returns the curves sampled from the observed machine as a [`Turn`].
    pub fn turn(self, machine: &Machine, law: &RopeLaw) -> Turn {
        let curves = self.recorder.curves;
        let [position, ..] = curves.suspension;
        Turn {
            period: std::f64::consts::TAU / machine.description.crank.speed,
            stress: curves
                .gauge
                .map(|curve| curve.iter().map(|pascal| pascal * 1e-6).collect()),
            position: position
                .iter()
                .map(|height| height - machine.lowest_suspension)
                .collect(),
            torque: curves.torque,
            push: self.push,
            tension: curves.back_tension,
            rope: machine.ropes(law).joint.stiffness[0] / machine.description.rope.back as f64,
        }
    }
}

impl Observe for Watch {
    fn sample(&mut self, index: usize, system: &mut System<RopeMachine<'_>>, state: &State) {
        self.recorder.sample(index, system, state);
        let individual = &system.equations;
        let beam = state.q[individual.machine.layout.beam()];
        let (s, c) = (libm::sin(beam), libm::cos(beam));
        let [x, y] = individual.head_push();
        self.push[0].push(c * x + s * y);
        self.push[1].push(c * y - s * x);
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        self.recorder.complete(machine, spacing);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_shift_by_a_share_of_the_turn_is_one_of_the_phase() {
        let wave = |phase: f64| -> Vec<f64> {
            (0..240)
                .map(|i| libm::cos(TAU * 3.0 * (f64::from(i) / 240.0 + phase)))
                .collect()
        };
        for (found, expected) in shifted(&wave(0.0), 0.013).iter().zip(wave(0.013)) {
            assert!((found - expected).abs() < 1e-5);
        }
    }
}
