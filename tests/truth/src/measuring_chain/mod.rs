//! Measuring chain: converts simulated turns of the machine to the samples of a test record.
//!
//! Cycles differ in load and speed; an index pulse marks each turn with a small timing error, and angles
//! between two pulses are interpolated linearly in time; gauges have zero offsets, coloured noise and a
//! finite resolution; a wireless link loses samples.
mod sensors;
mod time;

pub use sensors::Sensors;

use crate::draw::RandomStream;
use crate::law::HiddenEffect;
use crate::turn::Turn;
use sensors::{Link, Noise};
use simulation::math::spline::Splines;
use std::sync::Arc;
use time::CycleTimes;

/// Sensor values recorded at one instant of a test record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time at which the sample was taken, counted from the first index pulse \[s\].
    pub time: f64,
    /// Crank angle from bottom dead centre, interpolated between index pulses \[deg\].
    pub crank: f64,
    /// Measured stress at gauges 1 to 4 \[MPa\].
    pub stress: [f64; 4],
    /// Load of the delivered card at this crank angle \[N\].
    pub load: f64,
    /// Measured height of the suspension point \[m\].
    pub position: f64,
    /// Measured net torque at the crank [N m].
    pub torque: f64,
}

/// Simulated turn of the machine, and turns with one per cent more load swing and with half a per cent more
/// speed, from which sensitivities are computed.
#[derive(Clone, Debug)]
pub struct Turns {
    /// Crank turn simulated at nominal load and speed.
    pub plain: Turn,
    /// Crank turn simulated with the load swing increased by [`MORE_LOAD`].
    pub loaded: Turn,
    /// Crank turn simulated with the speed increased by [`MORE_SPEED`].
    pub fast: Turn,
}

/// Relative increase of the load swing in [`Turns::loaded`].
pub const MORE_LOAD: f64 = 0.01;
/// Relative increase of the speed in [`Turns::fast`].
pub const MORE_SPEED: f64 = 0.005;

/// Number of interpolated channels of a turn: four gauges, position, torque.
const CHANNELS: usize = 6;

/// Generates the samples of a test record; also returns the number of samples that the wireless link lost.
pub fn record(
    turns: &Turns,
    card: &[f64],
    laws: &[Arc<dyn HiddenEffect>],
    (sensors, cycles): (&Sensors, usize),
    draw: &mut RandomStream,
) -> (Vec<Sample>, usize) {
    let curves = Curves::new(turns);
    let card = Splines::periodic(0.0, 1.0 / card.len() as f64, &[card.to_vec()]);
    let time = CycleTimes::new(turns.plain.period, sensors, cycles, draw);
    let zero = [0.0; 4].map(|_: f64| sensors.zero * draw.normal());
    let mut noise = Noise::new(sensors, draw);
    let duration = cycles as f64 * turns.plain.period * 1.005;
    let mut link = Link::new(duration * sensors.rate, sensors.loss_probability, draw);
    let mut samples = Vec::new();
    let mut number: f64 = 0.0;
    while number < duration * sensors.rate {
        let at = number / sensors.rate;
        let turned = time.turns_at(at);
        let values = curves.at(turned, time.variation_at(turned));
        let colour = noise.next(draw);
        let mut stress = [0.0; 4];
        for (k, stress) in stress.iter_mut().enumerate() {
            let drift: f64 = laws.iter().map(|law| law.drift(turned)[k]).sum();
            let volts = values[k] + zero[k] + drift + colour[k];
            *stress = (volts / sensors.resolution).round() * sensors.resolution;
        }
        let crank = time.indicated(at);
        let sample = Sample {
            time: at,
            crank,
            stress,
            load: card.value(crank / 360.0, 0),
            position: values[4] + sensors.position_torque_noise[0] * draw.normal(),
            torque: values[5] + sensors.position_torque_noise[1] * draw.normal(),
        };
        if link.delivers(number, draw) {
            samples.push(sample);
        }
        number += 1.0;
    }
    (samples, link.lost)
}

/// Sensor curves of a simulated crank turn, and their sensitivities to load swing and speed.
struct Curves {
    plain: Splines,
    by_load: Splines,
    by_speed: Splines,
}

impl Curves {
    fn new(turns: &Turns) -> Self {
        let step = 1.0 / turns.plain.len() as f64;
        let plain = turns.plain.recorded();
        let change = |other: &Turn, amount: f64| {
            let rows = other
                .recorded()
                .into_iter()
                .zip(&plain)
                .map(|(other, plain)| {
                    let pairs = other.iter().zip(plain);
                    pairs
                        .map(|(other, plain)| (other - plain) / amount)
                        .collect()
                });
            Splines::periodic(0.0, step, &rows.collect::<Vec<Vec<f64>>>())
        };
        Self {
            by_load: change(&turns.loaded, MORE_LOAD),
            by_speed: change(&turns.fast, MORE_SPEED),
            plain: Splines::periodic(0.0, step, &plain),
        }
    }

    fn at(&self, turned: f64, [load, speed]: [f64; 2]) -> [f64; CHANNELS] {
        let (mut values, mut by_load, mut by_speed) =
            ([0.0; CHANNELS], [0.0; CHANNELS], [0.0; CHANNELS]);
        self.plain.values(&self.plain.place(turned), &mut values);
        self.by_load
            .values(&self.by_load.place(turned), &mut by_load);
        self.by_speed
            .values(&self.by_speed.place(turned), &mut by_speed);
        for (k, value) in values.iter_mut().enumerate() {
            *value += load * by_load[k] + speed * by_speed[k];
        }
        values
    }
}

/// Returns the crank speed of a condition [rad/s].
pub fn speed(rpm: f64) -> f64 {
    rpm * std::f64::consts::TAU / 60.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn turns() -> Turns {
        let n = 1440;
        let wave = |size: f64| -> Vec<f64> {
            (0..n)
                .map(|i| size * libm::cos(TAU * f64::from(i) / f64::from(n)))
                .collect()
        };
        let turn = |size: f64| Turn {
            period: 12.0,
            stress: [wave(size), wave(size), wave(size), wave(size)],
            position: wave(2.0),
            torque: wave(1e4),
            push: [wave(1.0), wave(1.0)],
            tension: wave(1.0),
            rope: 1.0,
        };
        Turns {
            plain: turn(10.0),
            loaded: turn(10.1),
            fast: turn(10.0),
        }
    }

    fn sampled(noise: f64, seed: u64) -> (Vec<Sample>, usize) {
        let card = vec![50e3; 720];
        let sensors = Sensors::with_noise(noise);
        record(
            &turns(),
            &card,
            &[],
            (&sensors, 5),
            &mut RandomStream::new(seed, "sensors"),
        )
    }

    #[test]
    fn noise_has_the_stated_size_colour_and_common_part() {
        let (samples, lost) = sampled(4.0, 3);
        assert_eq!(samples.len() + lost, 6030);
        assert!((8..60).contains(&lost), "{lost}");
        // what is left of gauges 1 and 2 without their common wave
        let rest: Vec<[f64; 2]> = samples
            .iter()
            .map(|s| {
                let wave = 10.0 * libm::cos(s.crank.to_radians());
                [s.stress[0] - wave, s.stress[1] - wave]
            })
            .collect();
        let n = rest.len() as f64;
        let mean = [0, 1].map(|k| rest.iter().map(|r| r[k]).sum::<f64>() / n);
        let product = |lag: usize, k: usize, l: usize| {
            let pairs = rest.iter().zip(&rest[lag..]);
            pairs
                .map(|(a, b)| (a[k] - mean[k]) * (b[l] - mean[l]))
                .sum::<f64>()
                / n
        };
        let variance = product(0, 0, 0);
        assert!((variance.sqrt() - 0.8).abs() < 0.05, "{}", variance.sqrt());
        assert!((product(1, 0, 0) / variance - 0.6).abs() < 0.08);
        assert!((product(0, 0, 1) / variance - 0.1).abs() < 0.06);
        let step = samples[17].stress[2] / 0.206;
        assert!((step - step.round()).abs() < 1e-9);
    }

    #[test]
    fn pulses_mark_five_turns_and_angles_grow_between_them() {
        let (samples, _) = sampled(1.0, 5);
        assert!(samples[0].time.abs() < 1e-12 && samples[0].crank.abs() < 1e-9);
        let back = samples
            .windows(2)
            .filter(|w| w[1].crank < w[0].crank)
            .count();
        assert_eq!(back, 5);
        assert_eq!(sampled(1.0, 5), sampled(1.0, 5));
        assert_ne!(sampled(1.0, 5), sampled(1.0, 6));
    }
}
