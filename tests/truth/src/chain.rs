//! The measuring chain: from turns of the machine to the samples of a record.
//!
//! Cycles differ in load and speed; an index pulse marks each turn a little early or late, and angles
//! between two pulses are taken as uniform in time; gauges have zeros, coloured noise and a step of
//! resolution; a wireless link loses samples.
use crate::draw::Draw;
use crate::law::Law;
use crate::turn::Turn;
use simulation::math::spline::Splines;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Sizes of what sensors do, as in the case's own records.
#[derive(Clone, Copy, Debug)]
pub struct Sensors {
    /// Samples a second \[Hz\].
    pub rate: f64,
    /// Noise of a gauge, rms \[MPa\].
    pub gauge_noise: f64,
    /// How much of it comes back in the next sample.
    pub correlation: f64,
    /// Share of its variance that all gauges have in common.
    pub common: f64,
    /// Step of a gauge's reading \[MPa\].
    pub resolution: f64,
    /// Spread of a gauge's zero \[MPa\].
    pub zero: f64,
    /// Noise of the position \[m\] and of the torque [N m].
    pub others: [f64; 2],
    /// Spread of the index pulse \[deg\].
    pub index: f64,
    /// Share of samples that are lost one by one.
    pub lost: f64,
    /// Spread of load swing and of speed from cycle to cycle.
    pub cycles: [f64; 2],
}

impl Sensors {
    /// With a factor on all noise.
    pub fn with_noise(factor: f64) -> Self {
        Self {
            rate: 100.0,
            gauge_noise: 0.2 * factor,
            correlation: 0.6,
            common: 0.1,
            resolution: 0.206,
            zero: 1.0,
            others: [0.002 * factor, 200.0 * factor],
            index: 0.1,
            lost: 0.0025,
            cycles: [0.004, 0.001],
        }
    }
}

/// One sample of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time \[s\].
    pub time: f64,
    /// Crank angle from bottom dead centre, as the pulses say \[deg\].
    pub crank: f64,
    /// Stress at gauges 1 to 4 \[MPa\].
    pub stress: [f64; 4],
    /// Load of the delivered card at that angle \[N\].
    pub load: f64,
    /// Height of the suspension point \[m\].
    pub position: f64,
    /// Net torque at the crank [N m].
    pub torque: f64,
}

/// The machine's turn, and turns with one per cent more swing of the load and half a per cent more
/// speed.
#[derive(Clone, Debug)]
pub struct Turns {
    /// As it is.
    pub plain: Turn,
    /// With [`MORE_LOAD`].
    pub loaded: Turn,
    /// With [`MORE_SPEED`].
    pub fast: Turn,
}

/// What the loaded turn has more of load.
pub const MORE_LOAD: f64 = 0.01;
/// What the fast turn has more of speed.
pub const MORE_SPEED: f64 = 0.005;

/// Recorded channels of a turn: four gauges, position, torque.
const CHANNELS: usize = 6;

/// Samples, and how many were lost.
pub fn record(
    turns: &Turns,
    card: &[f64],
    laws: &[Arc<dyn Law>],
    (sensors, cycles): (&Sensors, usize),
    draw: &mut Draw,
) -> (Vec<Sample>, usize) {
    let curves = Curves::new(turns);
    let card = Splines::periodic(0.0, 1.0 / card.len() as f64, &[card.to_vec()]);
    let time = Time::new(turns.plain.period, sensors, cycles, draw);
    let zero = [0.0; 4].map(|_: f64| sensors.zero * draw.normal());
    let mut noise = Noise::new(sensors, draw);
    let duration = cycles as f64 * turns.plain.period * 1.005;
    let mut link = Link::new(duration * sensors.rate, sensors.lost, draw);
    let mut samples = Vec::new();
    let mut number: f64 = 0.0;
    while number < duration * sensors.rate {
        let at = number / sensors.rate;
        let turned = time.turned(at);
        let values = curves.at(turned, time.varied(turned));
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
            position: values[4] + sensors.others[0] * draw.normal(),
            torque: values[5] + sensors.others[1] * draw.normal(),
        };
        if link.delivers(number, draw) {
            samples.push(sample);
        }
        number += 1.0;
    }
    (samples, link.lost)
}

/// Curves of a turn and how they change with load and speed.
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

/// When cycles begin, really and by their pulses, and what is different in each.
struct Time {
    /// Begin of each cycle and of one beyond the last \[s\].
    begin: Vec<f64>,
    /// The same as the pulses mark it.
    pulse: Vec<f64>,
    varied: Vec<[f64; 2]>,
}

impl Time {
    /// The record begins with the first pulse.
    fn new(period: f64, sensors: &Sensors, cycles: usize, draw: &mut Draw) -> Self {
        let varied: Vec<[f64; 2]> = (0..cycles + 2)
            .map(|_| sensors.cycles.map(|spread| spread * draw.cut_normal()))
            .collect();
        let mut begin = vec![0.0];
        let mut sum = 0.0;
        for [_, speed] in &varied {
            sum += period / (1.0 + speed);
            begin.push(sum);
        }
        let mut pulse: Vec<f64> = begin
            .iter()
            .map(|begin| begin + sensors.index / 360.0 * period * draw.cut_normal())
            .collect();
        let first = pulse[0];
        for time in begin.iter_mut().chain(&mut pulse) {
            *time -= first;
        }
        Self {
            begin,
            pulse,
            varied,
        }
    }

    /// Turns since the begin of the first cycle.
    fn turned(&self, at: f64) -> f64 {
        Self::share(&self.begin, at)
    }

    /// Crank angle by the pulses \[deg\].
    fn indicated(&self, at: f64) -> f64 {
        let turned = Self::share(&self.pulse, at);
        360.0 * (turned - turned.floor())
    }

    /// Number of the interval that a time is in, and the share of it that is over.
    fn share(marks: &[f64], at: f64) -> f64 {
        let left = marks
            .partition_point(|mark| *mark <= at)
            .clamp(1, marks.len() - 1)
            - 1;
        left as f64 + (at - marks[left]) / (marks[left + 1] - marks[left])
    }

    /// What differs, going over gently from the middle of a cycle to that of the next.
    fn varied(&self, turned: f64) -> [f64; 2] {
        let place = (turned - 0.5).max(0.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of cycles, not negative"
        )]
        let left = (place as usize).min(self.varied.len() - 2);
        let share = (place - left as f64).min(1.0);
        let (a, b) = (self.varied[left], self.varied[left + 1]);
        [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)
    }
}

/// Noise of the gauges: first order, a part of it common to all.
struct Noise {
    state: [f64; 5],
    kept: f64,
    fresh: f64,
    own: f64,
    common: f64,
}

impl Noise {
    fn new(sensors: &Sensors, draw: &mut Draw) -> Self {
        let kept = sensors.correlation;
        Self {
            state: [0.0; 5].map(|_: f64| draw.normal()),
            kept,
            fresh: (1.0 - kept * kept).sqrt(),
            own: sensors.gauge_noise * (1.0 - sensors.common).sqrt(),
            common: sensors.gauge_noise * sensors.common.sqrt(),
        }
    }

    fn next(&mut self, draw: &mut Draw) -> [f64; 4] {
        for state in &mut self.state {
            *state = self.kept * *state + self.fresh * draw.normal();
        }
        let [a, b, c, d, all] = self.state;
        [a, b, c, d].map(|own| self.own * own + self.common * all)
    }
}

/// A wireless link: single samples are lost, and one burst.
struct Link {
    burst: [f64; 2],
    share: f64,
    lost: usize,
}

impl Link {
    fn new(samples: f64, share: f64, draw: &mut Draw) -> Self {
        let begin = draw.between(0.1, 0.9) * samples;
        Self {
            burst: [begin, begin + draw.between(4.0, 14.0)],
            share,
            lost: 0,
        }
    }

    /// The first sample always arrives.
    fn delivers(&mut self, number: f64, draw: &mut Draw) -> bool {
        let in_burst = (self.burst[0]..self.burst[1]).contains(&number);
        let single = draw.unit() < self.share;
        let lost = number > 0.0 && (in_burst || single);
        self.lost += usize::from(lost);
        !lost
    }
}

/// The uniform speed of a condition [rad/s].
pub fn speed(rpm: f64) -> f64 {
    rpm * TAU / 60.0
}

#[cfg(test)]
mod tests {
    use super::*;

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
            &mut Draw::new(seed, "sensors"),
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

    #[test]
    fn what_differs_goes_over_gently() {
        let sensors = Sensors::with_noise(1.0);
        let time = Time::new(12.0, &sensors, 5, &mut Draw::new(1, "time"));
        for k in 0..500 {
            let [a, b] = [0.0, 0.01].map(|more| time.varied(0.01 * f64::from(k) + more));
            assert!((a[0] - b[0]).abs() < 3e-4);
        }
        assert!(
            time.begin
                .windows(2)
                .all(|w| (w[1] - w[0] - 12.0).abs() < 0.05)
        );
    }
}
