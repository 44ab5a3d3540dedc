//! Stand-in machine that the tool simulates: a periodic solution by harmonics.
//!
//! Three masses hang below a driven suspension: rod, beam, head, in the order in which the load reaches the
//! rope. `y` are their lags behind the drive: `M y'' + C y' + K y = f`, order by order of the crank; a
//! nonlinear term is a force or an imposed stretch, evaluated on a first, linear solution. Units: kN, m, t (2
//! pi t is a turn of the first condition).
use super::amounts::{Amounts, C, HIGHEST, MASSES};
use super::drive::{Drive, Warp, drive};
use super::lags::{Genes, Lags, solve};
use super::library;
use super::turn::FourierTable;
use crate::case::{SAMPLES, SPEED, card, grid};
use nalgebra::Vector3;
use protocol::announce::EffectDescriptor;
use protocol::job::{Counters, Observation, Reached, SimulateSpec, Verdict};
use protocol::pumping_unit::failure;

/// Stress per rope tension (MPa/kN), by gauge; `ALONG` is its relative change along the head, `BENDING` its
/// bending part.
const SENSITIVITY: [f64; 4] = [0.5, 0.35, 0.45, 0.3];
const ALONG: [f64; 4] = [0.8, -0.5, 0.3, 1.2];
const BENDING: [f64; 4] = [0.05, 0.03, -0.04, 0.02];
const CONTACT: [f64; 4] = [0.02, -0.05, 0.03, 0.06];
const WEAR: [f64; 4] = [1.0, 0.6, -0.4, 0.2];

/// Stand-in machine with its load cards and its effect library.
pub(crate) struct Machine {
    turn: FourierTable,
    cards: [Vec<C>; 2],
    library: Vec<EffectDescriptor>,
}

/// Effects that depend on the motion and are evaluated on a solution without them.
const BY_MOTION: [&str; 5] = [
    "pivot_friction",
    "stuffing_box_friction",
    "rod_drag",
    "pin_clearance",
    "rope_toe",
];

impl Machine {
    /// Creates the machine with its whole effect library.
    pub(crate) fn new() -> Self {
        let turn = FourierTable::new();
        let spectrum =
            |condition| turn.transform(&grid().map(|a| card(condition, a)).collect::<Vec<f64>>());
        let cards = [spectrum(0), spectrum(1)];
        let library = library::named()
            .into_iter()
            .chain(library::generic())
            .collect();
        Self {
            turn,
            cards,
            library,
        }
    }

    /// Returns the effects that the machine announces.
    pub(crate) fn library(&self) -> &[EffectDescriptor] {
        &self.library
    }

    fn load(&self, amounts: &Amounts<'_>, condition: usize) -> Vec<f64> {
        let shift = amounts.get("card_time_shift", 0).to_radians();
        let lag = amounts.get("load_cell_lag", 0) * SPEED[condition];
        let scale = 1.0 + amounts.get("load_cell_gain", 0);
        let spectrum: Vec<C> = self.cards[condition]
            .iter()
            .enumerate()
            .map(|(h, f)| {
                let half = C::new(1.0, 0.5 * h as f64 * lag);
                f * C::from_polar(scale, h as f64 * shift) * half * half
            })
            .collect();
        let offset = amounts.get("load_offset", 0);
        self.turn
            .curve(&spectrum)
            .iter()
            .map(|w| w + offset)
            .collect()
    }

    /// Simulates one turn of the crank; returns the sensor curves.
    pub(crate) fn observe(&self, spec: &SimulateSpec) -> Observation {
        let amounts = Amounts {
            library: &self.library,
            spec,
        };
        let ratio = SPEED[spec.individual.condition];
        let g = Genes::new(spec);
        if !(g.back > 50.0 && g.front > 5.0) {
            return failed();
        }
        let drive = drive(&amounts, ratio);
        let load = self.load(&amounts, spec.individual.condition);
        let forces = self.forces(&amounts, &drive, &load, ratio);
        let warp = Warp::new(&self.turn, &amounts);
        let linear = forces.map(|f| warp.enter(&self.turn, &f));
        let extra_mass = amounts.get("beam_inertia", 0);
        let mut lags = solve(&g, ratio, &linear, extra_mass);
        let mut tensions = (lags.rope(&g, ratio), lags.pin(&g, ratio));
        if BY_MOTION.iter().any(|id| amounts.on(id)) {
            for _ in 0..2 {
                let [on_rod, on_beam] = self.losses(&amounts, &drive, &load, &lags, ratio);
                let [pin, rope] = self.stretch(&amounts, &g, ratio, &tensions);
                let mut spectra = linear.clone();
                for h in 0..=HIGHEST {
                    spectra[0][h] += on_rod[h];
                    spectra[1][h] += on_beam[h] + pin[h];
                    spectra[2][h] += rope[h] - pin[h];
                }
                lags = solve(&g, ratio, &spectra, extra_mass);
                tensions = (lags.rope(&g, ratio), lags.pin(&g, ratio));
                for h in 0..=HIGHEST {
                    tensions.0[h] -= rope[h];
                    tensions.1[h] -= pin[h];
                }
            }
        }
        warp.leave(&self.turn, &mut lags, &mut tensions);
        self.channels(&amounts, &g, &drive, (&lags, &tensions), ratio)
    }

    /// Returns the downward forces on rod, beam and head.
    fn forces(
        &self,
        amounts: &Amounts<'_>,
        drive: &Drive,
        load: &[f64],
        ratio: f64,
    ) -> [Vec<f64>; 3] {
        let mass = [
            MASSES[0],
            MASSES[1] + amounts.get("beam_inertia", 0),
            MASSES[2],
        ];
        let mut forces: [Vec<f64>; 3] =
            mass.map(|m| drive.acceleration.iter().map(|a| m * a).collect());
        for (f, load) in forces[0].iter_mut().zip(load) {
            *f += load;
        }
        for (joint, force) in ["rod", "beam", "head"].iter().zip(&mut forces) {
            for (f, p) in force
                .iter_mut()
                .zip(self.probe(amounts.spec, joint, drive, ratio))
            {
                *f += p;
            }
        }
        forces
    }

    /// Returns the spectra of friction and drag on rod and beam, computed from their velocities in a
    /// solution.
    fn losses(
        &self,
        amounts: &Amounts<'_>,
        drive: &Drive,
        load: &[f64],
        lags: &Lags,
        ratio: f64,
    ) -> [Vec<C>; 2] {
        let (pivot, seal, drag) = (
            amounts.get("pivot_friction", 0),
            amounts.get("stuffing_box_friction", 0),
            amounts.get("rod_drag", 0),
        );
        let rate = |mass: usize| {
            let rate = |(h, y): (usize, &Vector3<C>)| y[mass] * C::new(0.0, h as f64 * ratio);
            self.turn
                .curve(&lags.0.iter().enumerate().map(rate).collect::<Vec<C>>())
        };
        let sign = |v: f64| (v / 0.06).tanh();
        let (rod, beam) = (rate(0), rate(1));
        let on_rod: Vec<f64> = (0..SAMPLES)
            .map(|i| drive.speed[i] - rod[i])
            .map(|v| seal * sign(v) + drag * v * v.abs())
            .collect();
        let on_beam: Vec<f64> = (0..SAMPLES)
            .map(|i| pivot * (load[i] + 20.0) * sign(drive.speed[i] - beam[i]))
            .collect();
        [self.turn.transform(&on_rod), self.turn.transform(&on_beam)]
    }

    /// Returns the sum of the probe forces at one joint, over the crank angle.
    fn probe(&self, spec: &SimulateSpec, joint: &str, drive: &Drive, ratio: f64) -> Vec<f64> {
        let mut sum = vec![0.0; SAMPLES];
        let prefix = format!("probe.{joint}.");
        for effect in &spec.individual.effects {
            let Some(form) = effect.id.strip_prefix(&prefix) else {
                continue;
            };
            let amplitude = effect.parameters.first().map_or(0.0, |(_, value)| *value);
            for (i, (angle, sum)) in grid().zip(&mut sum).enumerate() {
                let v = drive.speed[i] / (1.5 * ratio);
                let d = drive.height[i] / 1.5 - 1.0;
                let harmonic = |rest: &str| angle * rest.parse::<f64>().unwrap_or(0.0);
                *sum += amplitude
                    * match (form, form.get(..3)) {
                        ("const", _) => 1.0,
                        ("sgn_v", _) => (v / 0.05).tanh(),
                        ("v", _) => v,
                        ("v2", _) => v * v.abs(),
                        ("d2", _) => d * d,
                        ("d3", _) => d * d * d,
                        (_, Some("cos")) => harmonic(&form[3..]).cos(),
                        (_, Some("sin")) => harmonic(&form[3..]).sin(),
                        _ => 0.0,
                    };
            }
        }
        sum
    }

    /// Returns the stretches imposed by pin clearance and by the rope's soft initial range (toe), as
    /// equivalent forces across pin and back rope.
    fn stretch(
        &self,
        amounts: &Amounts<'_>,
        g: &Genes,
        ratio: f64,
        tensions: &(Vec<C>, Vec<C>),
    ) -> [Vec<C>; 2] {
        let (rope, pin) = (self.turn.curve(&tensions.0), self.turn.curve(&tensions.1));
        let (gap, at) = (
            amounts.get("pin_clearance", 0),
            amounts.get("pin_clearance", 1),
        );
        let toe = amounts.get("rope_toe", 0);
        let play: Vec<f64> = pin
            .iter()
            .map(|q| 0.5 * gap * (1.0 + ((q - at) / 3.0).tanh()))
            .collect();
        let soft: Vec<f64> = rope.iter().map(|t| -toe * (-t / 25.0).exp()).collect();
        let force = |stretch: &[f64], stiffness: f64, loss: f64| -> Vec<C> {
            let spectrum = self.turn.transform(stretch).into_iter().enumerate();
            spectrum
                .map(|(h, f)| C::new(stiffness, h as f64 * ratio * loss) * f)
                .collect()
        };
        [
            force(&play, g.contact, g.contact_loss),
            force(&soft, g.back, g.back_loss),
        ]
    }

    fn channels(
        &self,
        amounts: &Amounts<'_>,
        g: &Genes,
        drive: &Drive,
        (lags, tensions): (&Lags, &(Vec<C>, Vec<C>)),
        ratio: f64,
    ) -> Observation {
        let (rope, pin) = (self.turn.curve(&tensions.0), self.turn.curve(&tensions.1));
        let rod = self
            .turn
            .curve(&lags.0.iter().map(|y| y[0]).collect::<Vec<C>>());
        let (depth, place, width) = (
            amounts.get("head_profile_wear", 0),
            amounts.get("head_profile_wear", 1),
            amounts.get("head_profile_wear", 2),
        );
        let lag = amounts.get("amplifier_lag", 0) * ratio;
        let gauge = |c: usize| -> Vec<f64> {
            let gain = 1.0 + amounts.get("gauge_gain", c);
            let drift = amounts.get("gauge_drift", c);
            let raw: Vec<f64> = (0..SAMPLES)
                .map(|i| {
                    let along = drive.height[i] / 3.0;
                    let bend = g.bending * BENDING[c] * (7.0 * along + c as f64).sin();
                    let off = (along - place) / width;
                    let worn = depth * WEAR[c] * (-off * off).exp();
                    let late = 0.004 * g.bending_loss * drive.speed[i];
                    let tension = rope[i] * (1.0 + ALONG[c] * along + bend - worn + late);
                    SENSITIVITY[c] * tension + CONTACT[c] * pin[i]
                })
                .collect();
            let read = if lag > 0.0 {
                let late = self.turn.transform(&raw).into_iter().enumerate();
                let slow: Vec<C> = late.map(|(h, f)| f / C::new(1.0, h as f64 * lag)).collect();
                self.turn.curve(&slow)
            } else {
                raw
            };
            read.iter()
                .enumerate()
                .map(|(i, y)| gain * y + drift * (i as f64 / SAMPLES as f64 - 0.5))
                .collect()
        };
        let phase = amounts.get("counterweight_phase", 0).to_radians();
        let extra = self.probe(amounts.spec, "crank", drive, ratio);
        let torque = grid().enumerate().map(|(i, angle)| {
            rope[i] * drive.slope[i] - 90.0 * (angle + phase).sin()
                + 1e-4 * g.torsion * drive.speed[i]
                + extra[i]
        });
        let suspension = drive.height.iter().zip(&rod).map(|(s, y)| s - y);
        let mut curves = vec![gauge(0), gauge(1), gauge(2), gauge(3)];
        curves.extend([suspension.collect(), torque.collect()]);
        Observation {
            verdict: Verdict::Complete,
            counters: Counters::default(),
            curves,
            columns: Vec::new(),
        }
    }
}

fn failed() -> Observation {
    Observation {
        verdict: Verdict::Failed {
            kind: failure::OVERSTRETCHED_ROPE,
            reached: Reached::LoadFraction(0.1),
        },
        counters: Counters::default(),
        curves: vec![Vec::new(); 6],
        columns: Vec::new(),
    }
}
