//! Simulation of the true machine by time stepping, with laws other than the tool's, and of the sensors that
//! read it. Shares the data sheet with the tool's machine and not one line of code.
use crate::case::{RECOMMENDED, SAMPLES, SPEED, card};
use protocol::case::{Abscissa, Channel, Offset};
use record::{Curves, InputScatter, Record, Recorded, Stated};
use search::random::{Phase, Stream, Streams};
use std::f64::consts::TAU;

/// Number of time steps per turn.
const STEPS: usize = 720;
/// Maximum number of turns after which the simulated motion must be periodic.
const TURNS: usize = 60;

/// Effect of the true machine that is not in the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unlisted {
    /// A hardening spring under the beam (kN at full stroke).
    BeamSpring(f64),
    /// A periodic force on the head, three times per turn (kN).
    HeadThrice(f64),
    /// A dashpot on the rod (kN/(m/t)).
    RodDashpot(f64),
    /// A drag at the beam's bearing by the square of its speed (kN/(m/t)^2).
    BeamDrag(f64),
    /// A gear mesh torque that brakes the crank four times per turn (kN m).
    GearMesh(f64),
    /// Coulomb friction of the gearbox teeth (kN m).
    GearFriction(f64),
    /// A mass oscillating on the beam at 3.3 times the crank's frequency (mass in the unit of the machine's
    /// masses).
    SwingingMass(f64),
}

/// True machine with its hidden effects and its noise.
#[derive(Clone, Debug)]
pub(crate) struct Truth {
    /// True values of the machine's unknowns, as decades from the recommended values.
    pub(crate) genes: [f64; 10],
    /// Hidden effects of the library with their parameter values, in the library's order.
    pub(crate) effects: Vec<(String, Vec<f64>)>,
    /// Hidden effect that is not in the library.
    pub(crate) unlisted: Option<Unlisted>,
    /// Noise of the sensors, as a factor of the usual noise.
    pub(crate) noise: f64,
    /// Seed of the noise.
    pub(crate) seed: u64,
}

impl Truth {
    /// Returns a healthy machine whose unknowns are drawn at random around the recommended values.
    pub(crate) fn healthy(seed: u64) -> Self {
        let mut stream = Streams::new(seed, 7).at(0, Phase::Initial, 0);
        let spread = [0.10, 0.15, 0.3, 0.2, 0.25, 0.25, 0.3, 0.2, 0.12, 0.25];
        Self {
            genes: spread.map(|s| s * stream.normal().clamp(-2.0, 2.0)),
            effects: Vec::new(),
            unlisted: None,
            noise: 1.0,
            seed,
        }
    }

    /// Scales the noise by a factor.
    #[must_use]
    pub(crate) const fn noisy(mut self, factor: f64) -> Self {
        self.noise = factor;
        self
    }

    /// Adds a hidden effect of the library with its parameter values.
    #[must_use]
    pub(crate) fn with(mut self, id: &str, amounts: &[f64]) -> Self {
        self.effects.push((id.to_owned(), amounts.to_vec()));
        self
    }

    fn amount(&self, id: &str, k: usize) -> f64 {
        let own = self.effects.iter().find(|(name, _)| name == id);
        own.and_then(|(_, amounts)| amounts.get(k))
            .copied()
            .unwrap_or(0.0)
    }

    fn values(&self) -> [f64; 10] {
        std::array::from_fn(|k| RECOMMENDED[k] * 10_f64.powf(self.genes[k]))
    }
}

/// Returns height (m), slope (m/rad) and curvature (m/rad^2) of the drive's motion at a crank angle: the
/// value and its first and second derivative by the angle.
fn drive(angle: f64) -> [f64; 3] {
    let quarter = 1.0 / 4.0;
    let height = 1.5 * (1.0 - angle.cos()) + 1.5 * quarter * quarter * (1.0 - (2.0 * angle).cos());
    let slope = 1.5 * angle.sin() + 3.0 * quarter * quarter * (2.0 * angle).sin();
    let bend = 1.5 * angle.cos() + 6.0 * quarter * quarter * (2.0 * angle).cos();
    [height, slope, bend]
}

/// Time integration of one cycle under one condition, with a random scale factor of the cycle's load.
struct TimeIntegration<'a> {
    truth: &'a Truth,
    condition: usize,
    scale: f64,
    genes: [f64; 10],
}

/// Sensor readings at one angle: four gauges, position, torque.
type Reading = [f64; 6];

/// State of the time integration: lags of rod, beam, head and swinging mass behind the drive, then the rates
/// of the lags.
type State = [f64; 8];

impl TimeIntegration<'_> {
    /// Returns the crank's angular rate, relative to that of the first condition, and the derivative of that
    /// rate by the angle.
    fn rate(&self, angle: f64) -> [f64; 2] {
        let ratio = SPEED[self.condition];
        let (a, b) = (
            self.truth.amount("crank_speed_ripple", 0),
            self.truth.amount("crank_speed_ripple", 1),
        );
        // constant in energy rather than in speed, and a little of the second order
        let swing = a * angle.cos() + b * angle.sin();
        let rate = ratio * (1.0 + 2.0 * swing).max(0.1).sqrt();
        [
            rate,
            ratio * ratio * (b * angle.cos() - a * angle.sin()) / rate,
        ]
    }

    fn load(&self, angle: f64) -> f64 {
        let shifted = angle + self.truth.amount("card_time_shift", 0).to_radians();
        let gain = self.scale * (1.0 + self.truth.amount("load_cell_gain", 0));
        let lag = self.truth.amount("load_cell_lag", 0);
        let step = 1e-4;
        let slope = (card(self.condition, shifted + step) - card(self.condition, shifted - step))
            / (2.0 * step);
        gain * (card(self.condition, shifted) + lag * SPEED[self.condition] * slope)
            + self.truth.amount("load_offset", 0)
    }

    fn friction(size: f64, v: f64) -> f64 {
        // Stribeck: stronger where it is slow
        size * (1.0 + 0.15 * (-(v / 0.25) * (v / 0.25)).exp()) * v / v.hypot(0.03)
    }

    /// Returns the force between beam and head at a relative lag and its rate.
    fn pin(&self, lag: f64, rate: f64) -> f64 {
        let (stiffness, loss) = (self.genes[8], self.genes[9]);
        let (gap, at) = (
            self.truth.amount("pin_clearance", 0),
            self.truth.amount("pin_clearance", 1),
        );
        let loss = loss * rate;
        if gap <= 0.0 {
            return stiffness * lag + loss;
        }
        // a play that is run through between 2 kN below and 2 kN above
        let (low, high) = (at - 2.0, at + 2.0);
        let (begin, end) = (low / stiffness, high / stiffness + gap);
        let force = if lag < begin {
            stiffness * lag
        } else if lag > end {
            stiffness * (lag - gap)
        } else {
            low + (high - low) * (lag - begin) / (end - begin)
        };
        force + loss
    }

    fn rope(&self, lag: f64, rate: f64) -> f64 {
        let (stiffness, loss) = (self.genes[0], self.genes[4]);
        let toe = self.truth.amount("rope_toe", 0);
        let slack = (1.0 - stiffness * lag / 70.0).clamp(0.0, 1.5);
        stiffness * (lag + toe * slack * slack) + loss * rate
    }

    fn derivative(&self, angle: f64, state: &State, load: f64) -> State {
        let truth = self.truth;
        let offset = truth.amount("crank_angle_offset", 0).to_radians();
        let [height, slope, bend] = drive(angle + offset);
        let [rate, change] = self.rate(angle);
        let acceleration = bend * rate * rate + slope * rate * change;
        let v = slope * rate;
        let [
            rod,
            beam,
            head,
            swing,
            rod_rate,
            beam_rate,
            head_rate,
            swing_rate,
        ] = *state;
        let front = self.genes[1] * (rod - beam) + self.genes[5] * (rod_rate - beam_rate);
        let pin = self.pin(beam - head, beam_rate - head_rate);
        let rope = self.rope(head, head_rate);
        let mut on_rod =
            load + Self::friction(truth.amount("stuffing_box_friction", 0), v - rod_rate);
        on_rod += truth.amount("rod_drag", 0) * (v - rod_rate) * (v - rod_rate).abs();
        let mut on_beam = Self::friction(
            truth.amount("pivot_friction", 0) * (load + 20.0),
            v - beam_rate,
        );
        let mut on_head = 0.0;
        let (mut swing_force, mut swing_mass) = (0.0, 1.0);
        match truth.unlisted {
            Some(Unlisted::BeamSpring(size)) => {
                on_beam += size * ((height - beam) / 1.5 - 1.0).powi(3);
            }
            Some(Unlisted::BeamDrag(size)) => {
                on_beam += size * (v - beam_rate) * (v - beam_rate).abs();
            }
            Some(Unlisted::HeadThrice(size)) => on_head += size * (3.0 * angle + 1.0).cos(),
            Some(Unlisted::RodDashpot(size)) => on_rod += size * (v - rod_rate),
            Some(Unlisted::SwingingMass(mass)) => {
                swing_mass = mass;
                swing_force =
                    mass * 3.3 * 3.3 * (swing - beam) + mass * 0.6 * (swing_rate - beam_rate);
                on_beam += swing_force;
            }
            Some(Unlisted::GearMesh(_) | Unlisted::GearFriction(_)) | None => {}
        }
        let beam_mass = 4.0 + truth.amount("beam_inertia", 0);
        // a little loss to the ground that the tool has not
        let air = 2e-3;
        [
            rod_rate / rate,
            beam_rate / rate,
            head_rate / rate,
            swing_rate / rate,
            ((on_rod - front) / 2.0 + acceleration - air * rod_rate) / rate,
            ((on_beam + front - pin) / beam_mass + acceleration - air * beam_rate) / rate,
            ((on_head + pin - rope) / 5.9 + acceleration) / rate,
            (acceleration - swing_force / swing_mass) / rate,
        ]
    }

    /// Integrates until the motion is periodic and returns the readings of the last turn, at every step.
    fn turn(&self) -> Vec<Reading> {
        let step = TAU / STEPS as f64;
        let loads: Vec<f64> = (0..2 * STEPS)
            .map(|i| self.load(0.5 * step * i as f64))
            .collect();
        let stiff = [self.genes[0], self.genes[8], self.genes[1]];
        let head = loads[0] / stiff[0];
        let beam = head + loads[0] / stiff[1];
        let mut state: State = [
            beam + loads[0] / stiff[2],
            beam,
            head,
            beam,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        let mut readings = Vec::with_capacity(STEPS);
        for _ in 0..TURNS {
            readings.clear();
            let begin = state;
            for n in 0..STEPS {
                let angle = step * n as f64;
                readings.push(self.read(angle, &state, n));
                let load = |k: usize| loads[(2 * n + k) % (2 * STEPS)];
                let moved =
                    |k: &State, h: f64| -> State { std::array::from_fn(|j| state[j] + h * k[j]) };
                let k1 = self.derivative(angle, &state, load(0));
                let k2 = self.derivative(angle + 0.5 * step, &moved(&k1, 0.5 * step), load(1));
                let k3 = self.derivative(angle + 0.5 * step, &moved(&k2, 0.5 * step), load(1));
                let k4 = self.derivative(angle + step, &moved(&k3, step), load(2));
                state = std::array::from_fn(|j| {
                    state[j] + step / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j])
                });
            }
            // lags of 20 mm and rates of 0.2 m/t, to a ten-thousandth
            let still = |(a, b): (&f64, &f64)| (a - b).abs() < 2e-6;
            if begin.iter().zip(&state).take(3).all(still) {
                break;
            }
        }
        self.amplify(&mut readings);
        readings
    }

    fn read(&self, angle: f64, state: &State, n: usize) -> Reading {
        let truth = self.truth;
        let [height, slope, _] = drive(angle + truth.amount("crank_angle_offset", 0).to_radians());
        let [rod, beam, head, _, _, beam_rate, head_rate, _] = *state;
        let rope = self.rope(head, head_rate);
        let pin = self.pin(beam - head, beam_rate - head_rate);
        let along = height / 3.0;
        let speed = slope * self.rate(angle)[0];
        let bending = 10_f64.powf(0.3 * truth.genes[3]);
        let late = 0.004 * 10_f64.powf(0.3 * truth.genes[7]) * speed;
        let worn = {
            let (depth, place, width) = (
                truth.amount("head_profile_wear", 0),
                truth.amount("head_profile_wear", 1),
                truth.amount("head_profile_wear", 2),
            );
            // a groove with steep flanks
            let off = if depth > 0.0 {
                (along - place) / width
            } else {
                9.0
            };
            depth * 1.1 / (1.0 + off.powi(4))
        };
        let table = [
            (0.5, 0.8, 0.05, 0.02, 1.0),
            (0.35, -0.5, 0.03, -0.05, 0.6),
            (0.45, 0.3, -0.04, 0.03, -0.4),
            (0.3, 1.2, 0.02, 0.06, 0.2),
        ];
        let mut out = [0.0; 6];
        for (c, (tension, by_place, by_bend, by_pin, wear)) in table.into_iter().enumerate() {
            let factor =
                1.0 + by_place * along + bending * by_bend * (7.0 * along + c as f64).sin();
            let drift = truth.amount("gauge_drift", c);
            let turn = n as f64 / STEPS as f64 - 0.5;
            out[c] = (1.0 + truth.amount("gauge_gain", c))
                * (tension * rope * (factor - wear * worn + late) + by_pin * pin)
                + drift * (turn + 0.1 * turn * (0.25 - turn * turn));
        }
        let phase = truth.amount("counterweight_phase", 0).to_radians();
        let mesh = match truth.unlisted {
            Some(Unlisted::GearMesh(size)) => size * (4.0 * angle + 0.6).cos(),
            Some(Unlisted::GearFriction(size)) => size * speed / speed.hypot(0.05),
            _ => 0.0,
        };
        out[4] = height - rod;
        out[5] = rope * slope - 90.0 * (angle + phase).sin()
            + 1e-4 * 10_f64.powf(truth.genes[2]) * speed
            + mesh;
        out
    }

    /// Applies the gauge amplifier's lag to the readings, passing over the turn twice to reach the periodic
    /// state.
    fn amplify(&self, readings: &mut [Reading]) {
        let lag = self.truth.amount("amplifier_lag", 0) * SPEED[self.condition];
        if lag <= 0.0 {
            return;
        }
        // exact for a reading that is straight between two samples
        let ratio = TAU / STEPS as f64 / lag;
        let keep = (-ratio).exp();
        let before = (1.0 - keep) / ratio - keep;
        let fresh = readings.to_vec();
        let mut slow = fresh[STEPS - 1];
        let mut last = slow;
        for (i, now) in fresh.iter().chain(&fresh).enumerate() {
            for c in 0..4 {
                slow[c] = keep * slow[c] + before * last[c] + (1.0 - keep - before) * now[c];
            }
            last = *now;
            readings[i % STEPS][..4].copy_from_slice(&slow[..4]);
        }
    }
}

/// Standard deviation of the noise of one sample, by channel: gauges (MPa), position, torque.
const NOISE: [f64; 6] = [0.25, 0.2, 0.25, 0.2, 2e-3, 0.4];
/// Correlation of the noise from sample to sample.
const CORRELATION: f64 = 0.5;
/// Relative standard deviation of the load from cycle to cycle; `ANGLE_TOLERANCE_DEG` bounds the scatter of
/// the angle (deg).
const LOAD_SCATTER: f64 = 0.003;
const ANGLE_TOLERANCE_DEG: f64 = 0.1;

/// Channels of a full record, as indices of an observation's curves: four gauges, position, torque.
pub(crate) const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];

/// Creates a record's channel with its stated noise; the gap is counted on gauges (curves 0 to 3) only.
pub(crate) fn recorded(curve: usize, samples: usize, noise: Option<f64>) -> Recorded {
    let step = 360.0 / samples as f64;
    let channel = Channel {
        limit: None,
        name: format!("channel_{curve}"),
        title: format!("channel {curve}"),
        unit: "1".to_owned(),
        condition: 0,
        abscissa: Abscissa {
            name: "crank".to_owned(),
            unit: "deg".to_owned(),
            points: (0..samples).map(|i| step * i as f64).collect(),
            period: Some(360.0),
        },
        noise,
        step: None,
        weights: Vec::new(),
        offset: Offset::Free,
        record: None,
    };
    Recorded {
        curve,
        scored: curve < 4,
        held_out: false,
        rows: None,
        correlation: Some(CORRELATION),
        model_error: None,
        channel,
    }
}

/// Returns a record of a number of cycles of a true machine.
pub(crate) fn record(truth: &Truth, condition: usize, channels: &[usize], cycles: usize) -> Record {
    let streams = Streams::new(truth.seed, 11);
    let mut stream = streams.at(condition as u32, Phase::Initial, 0);
    let zeros: [f64; 6] = std::array::from_fn(|c| if c < 4 { 5.0 * stream.normal() } else { 0.0 });
    let cycles = (0..cycles)
        .map(|k| {
            let mut stream = streams.at(condition as u32, Phase::Resample, k);
            cycle(truth, condition, &mut stream, &zeros, channels)
        })
        .collect();
    let wanted = |&c: &usize| recorded(c, SAMPLES, Some(NOISE[c] * truth.noise));
    Record {
        condition,
        channels: channels.iter().map(wanted).collect(),
        cycles,
        held_out: false,
        stated: Stated {
            input_scatter: vec![
                InputScatter::Abscissa {
                    tolerance: ANGLE_TOLERANCE_DEG,
                },
                InputScatter::Effect {
                    id: "load_cell_gain".to_owned(),
                    deviation: LOAD_SCATTER,
                },
            ],
            ..Stated::default()
        },
    }
}

fn cycle(
    truth: &Truth,
    condition: usize,
    stream: &mut Stream,
    zeros: &[f64; 6],
    channels: &[usize],
) -> Curves {
    let scale = 1.0 + LOAD_SCATTER * stream.normal();
    let readings = TimeIntegration {
        truth,
        condition,
        scale,
        genes: truth.values(),
    }
    .turn();
    let shift = ANGLE_TOLERANCE_DEG * (2.0 * stream.unit() - 1.0) * STEPS as f64 / 360.0;
    let each = STEPS as f64 / SAMPLES as f64;
    let at = |c: usize, i: usize| {
        // cubic through four neighbours
        let x = (i as f64 * each + shift).rem_euclid(STEPS as f64);
        let (n, t) = (x as usize, x.fract());
        let y = |k: usize| readings[(n + k + STEPS - 1) % STEPS][c];
        let (a, b, c, d) = (y(0), y(1), y(2), y(3));
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    };
    let mut noise = Noise::default();
    let mut all: Curves = vec![Vec::with_capacity(SAMPLES); 6];
    for i in 0..SAMPLES {
        let drawn = noise.next(stream);
        for (c, curve) in all.iter_mut().enumerate() {
            curve.push(at(c, i) + zeros[c] + truth.noise * NOISE[c] * drawn[c]);
        }
    }
    channels
        .iter()
        .map(|&c| std::mem::take(&mut all[c]))
        .collect()
}

/// Returns cycles in which all channels hold noise only.
pub(crate) fn cycles_of_noise(seed: u64, cycles: usize) -> Vec<Curves> {
    let streams = Streams::new(seed, 13);
    let one = |k: usize| {
        let mut stream = streams.at(0, Phase::Resample, k);
        let mut noise = Noise::default();
        let mut curves: Curves = vec![Vec::with_capacity(SAMPLES); NOISE.len()];
        for _ in 0..SAMPLES {
            let drawn = noise.next(&mut stream);
            for ((curve, drawn), size) in curves.iter_mut().zip(drawn).zip(NOISE) {
                curve.push(size * drawn);
            }
        }
        curves
    };
    (0..cycles).map(one).collect()
}

/// First-order autoregressive noise of all channels, with a component common to the gauges.
#[derive(Default)]
struct Noise {
    last: [f64; 7],
}

impl Noise {
    fn next(&mut self, stream: &mut Stream) -> [f64; 6] {
        let fresh = (1.0 - CORRELATION * CORRELATION).sqrt();
        for value in &mut self.last {
            *value = CORRELATION * *value + fresh * stream.normal();
        }
        let common = self.last[6];
        std::array::from_fn(|c| {
            if c < 4 {
                0.8_f64.sqrt() * self.last[c] + 0.2_f64.sqrt() * common
            } else {
                self.last[c]
            }
        })
    }
}

/// Adds a smooth curve to every cycle of a record: `size` standard errors of the mean of each channel, with a
/// correlation length of a twentieth of the turn.
pub(crate) fn add_smooth_error(record: &mut Record, size: f64, seed: u64) {
    /// Highest order of the error: the spectrum has fallen to a hundredth there.
    const ORDERS: u32 = 10;
    let streams = Streams::new(seed, 41);
    let share = |order: u32| (-0.5 * (TAU * f64::from(order) / 20.0).powi(2)).exp();
    let whole: f64 = (1..=ORDERS).map(share).sum();
    let count = record.cycles.len() as f64;
    for (c, own) in record.channels.iter().enumerate() {
        let mut stream = streams.at(record.condition as u32, Phase::Initial, c);
        let deviation = size * own.channel.noise.expect("a stand-in states it") / count.sqrt();
        let abscissa = &own.channel.abscissa;
        let mut error = vec![0.0; abscissa.points.len()];
        for order in 1..=ORDERS {
            let scale = deviation * (share(order) / whole).sqrt();
            let [a, b] = [0, 1].map(|_| scale * stream.normal());
            for (y, angle) in error.iter_mut().zip(&abscissa.points) {
                let turn = f64::from(order) * angle.to_radians();
                *y += a * turn.cos() + b * turn.sin();
            }
        }
        for cycle in &mut record.cycles {
            for (y, error) in cycle[c].iter_mut().zip(&error) {
                *y += error;
            }
        }
    }
}
