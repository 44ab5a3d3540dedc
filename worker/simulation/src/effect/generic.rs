//! Generic forces for localisation: combinations of a joint and a force law, without a physical cause.
//!
//! The effects are the product of a table of joints and a table of force laws. A force of unit amplitude is a
//! function of displacement `u` and rate `w`, both relative to their largest values in the ideal motion, and
//! of the turn angle: constant, `sgn w` (as a steep `tanh`), `w`, `w |w|`, `u^2`, `u^3`, and cosine or sine
//! of the first six harmonics of the crank. Forces that depend on the motion resist it; the amplitude may
//! have either sign.
use super::descriptor::{Descriptor, Place};
use super::unit::Unit;
use crate::drive::DriveState;
use crate::math::elementary::{sin_cos, tanh};
use crate::math::spline::Splines;
use crate::model::extension::{Axial, Effect, Extensions, LineForce, LineForceValue, Site, Strain};
use crate::model::parallel_ropes::{BACK, FRONT};
use std::f64::consts::TAU;

/// Location where a generic force may act.
#[derive(Debug)]
struct Joint {
    name: &'static str,
    title: &'static str,
    line: CoordinateKind,
    unit: Unit,
    /// Typical amplitude of the generic force at this joint, in `unit`.
    typical: f64,
}

/// Kind of coordinate on which a generic force acts, such as the beam angle or the extension of a rope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CoordinateKind {
    Beam,
    Suspension,
    Rod,
    Head,
    Rope(usize),
}

const JOINTS: [Joint; 6] = [
    Joint {
        name: "saddle",
        title: "Moment at the saddle bearing",
        line: CoordinateKind::Beam,
        unit: Unit::NewtonMetre,
        typical: 1500.0,
    },
    Joint {
        name: "suspension",
        title: "Force at the suspension point",
        line: CoordinateKind::Suspension,
        unit: Unit::Newton,
        typical: 800.0,
    },
    Joint {
        name: "crank_pin",
        title: "Moment between crank and rod",
        line: CoordinateKind::Rod,
        unit: Unit::NewtonMetre,
        typical: 1000.0,
    },
    Joint {
        name: "back_head",
        title: "Force on the back head's first mode",
        line: CoordinateKind::Head,
        unit: Unit::ModalNewton,
        typical: 10.0,
    },
    Joint {
        name: "back_rope",
        title: "Pull along the back rope",
        line: CoordinateKind::Rope(BACK),
        unit: Unit::Newton,
        typical: 1000.0,
    },
    Joint {
        name: "front_rope",
        title: "Pull along the front rope",
        line: CoordinateKind::Rope(FRONT),
        unit: Unit::Newton,
        typical: 1000.0,
    },
];

/// Law of a generic force: its dependence on displacement, rate and turn angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Constant,
    SignOfRate,
    Rate,
    RateSquared,
    PlaceSquared,
    PlaceCubed,
    Cosine(u8),
    Sine(u8),
}

const HARMONICS: u8 = 6;

impl Form {
    fn all() -> impl Iterator<Item = Self> {
        let motion = [
            Self::Constant,
            Self::SignOfRate,
            Self::Rate,
            Self::RateSquared,
            Self::PlaceSquared,
            Self::PlaceCubed,
        ];
        let time = (1..=HARMONICS).flat_map(|h| [Self::Cosine(h), Self::Sine(h)]);
        motion.into_iter().chain(time)
    }

    fn name(self) -> String {
        match self {
            Self::Constant => "const".to_owned(),
            Self::SignOfRate => "sgn_v".to_owned(),
            Self::Rate => "v".to_owned(),
            Self::RateSquared => "v_abs_v".to_owned(),
            Self::PlaceSquared => "d2".to_owned(),
            Self::PlaceCubed => "d3".to_owned(),
            Self::Cosine(h) => format!("cos{h}"),
            Self::Sine(h) => format!("sin{h}"),
        }
    }

    fn words(self) -> String {
        match self {
            Self::Constant => "constant".to_owned(),
            Self::SignOfRate => "proportional to the sign of the speed".to_owned(),
            Self::Rate => "proportional to the speed".to_owned(),
            Self::RateSquared => "proportional to the square of the speed".to_owned(),
            Self::PlaceSquared => "proportional to the square of the displacement".to_owned(),
            Self::PlaceCubed => "proportional to the cube of the displacement".to_owned(),
            Self::Cosine(h) => format!("cosine of harmonic {h}"),
            Self::Sine(h) => format!("sine of harmonic {h}"),
        }
    }

    /// Computes the force of this law at unit amplitude, from relative displacement `u`, relative rate `w`
    /// and the turn angle; its energy is the integral over the dimensionless `u`.
    fn resistance(self, u: f64, w: f64, turn: f64) -> LineForceValue {
        let mut along = LineForceValue::default();
        match self {
            Self::Constant => along.non_conservative = 1.0,
            Self::SignOfRate => {
                along.non_conservative = tanh(w / REGULARISATION_RATE);
                along.by_rate =
                    (1.0 - along.non_conservative * along.non_conservative) / REGULARISATION_RATE;
            }
            Self::Rate => (along.non_conservative, along.by_rate) = (w, 1.0),
            Self::RateSquared => {
                (along.non_conservative, along.by_rate) = (w * w.abs(), 2.0 * w.abs());
            }
            Self::PlaceSquared => {
                (along.spring, along.by_place, along.energy) = (u * u, 2.0 * u, u * u * u / 3.0);
            }
            Self::PlaceCubed => {
                let square = u * u;
                along.spring = square * u;
                along.by_place = 3.0 * square;
                along.energy = 0.25 * square * square;
            }
            Self::Cosine(h) => along.non_conservative = sin_cos(f64::from(h) * turn).1,
            Self::Sine(h) => along.non_conservative = sin_cos(f64::from(h) * turn).0,
        }
        along
    }
}

/// Returns the descriptors of all generic forces.
pub(super) fn descriptors() -> impl Iterator<Item = Descriptor> {
    JOINTS.iter().flat_map(|joint| {
        Form::all().map(move |form| {
            let reach = 20.0 * joint.typical;
            let id = format!("probe.{}.{}", joint.name, form.name());
            Descriptor::new(id, format!("{}, {}", joint.title, form.words()))
                .with_location(joint.name, Place::Dynamics)
                .generic()
                .size("amplitude", joint.unit, joint.typical, [-reach, reach])
                .with_constructor(move |v| Probe {
                    line: joint.line,
                    form,
                    amplitude: v.get("amplitude"),
                })
        })
    })
}

#[derive(Clone, Copy, Debug)]
struct Probe {
    line: CoordinateKind,
    form: Form,
    amplitude: f64,
}

/// Middle, half range and largest rate of a coordinate in the ideal motion; scales of a generic force.
#[derive(Clone, Copy, Debug)]
struct Range {
    middle: f64,
    reach: f64,
    rate: f64,
}

/// Rate, as a share of the coordinate's largest rate, at which the regularised dry friction reaches three
/// quarters of its full value.
const REGULARISATION_RATE: f64 = 0.02;

impl Range {
    /// Computes the range of a function of the turn angle, for a crank at `speed` [rad/s].
    fn of(speed: f64, motion: impl Fn(f64) -> f64) -> Self {
        const NODES: u32 = 360;
        let at = |k: u32| motion(TAU * f64::from(k) / f64::from(NODES));
        let (mut low, mut high, mut steepest) = (f64::MAX, f64::MIN, 0.0_f64);
        for k in 0..NODES {
            let value = at(k);
            low = low.min(value);
            high = high.max(value);
            steepest = steepest.max((at(k + 1) - value).abs());
        }
        Self {
            middle: 0.5 * (low + high),
            reach: 0.5 * (high - low),
            rate: steepest * f64::from(NODES) / TAU * speed,
        }
    }

    /// Computes a generic force, scaled by its amplitude, at a displacement and rate of its coordinate and a
    /// turn angle.
    fn resistance(&self, probe: &Probe, place: f64, rate: f64, turn: f64) -> LineForceValue {
        let u = (place - self.middle) / self.reach;
        let unit = probe.form.resistance(u, rate / self.rate, turn);
        let a = probe.amplitude;
        LineForceValue {
            spring: a * unit.spring,
            non_conservative: a * unit.non_conservative,
            energy: a * self.reach * unit.energy,
            by_place: a * unit.by_place / self.reach,
            by_rate: a * unit.by_rate / self.rate,
        }
    }
}

impl Effect for Probe {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let (d, layout, cycle) = (site.description, site.layout, site.cycle);
        let speed = d.crank.speed;
        let (index, range) = match self.line {
            CoordinateKind::Rope(rope) => {
                let (slow, weight) = if rope == BACK {
                    (cycle.tensions().clone(), 0.0)
                } else {
                    (site.card.clone(), d.suspension_mass * d.gravity)
                };
                let tension = Range::of(speed, |turn| slow.value(turn, 0) + weight);
                let law = AlongRope {
                    probe: *self,
                    tension,
                    slow,
                    sense: d.crank.sense,
                };
                extensions.add_axial(rope, law);
                return;
            }
            CoordinateKind::Beam => (
                layout.beam(),
                Range::of(speed, |turn| cycle.beam(turn).value),
            ),
            CoordinateKind::Suspension => {
                let length = d.rope.front as f64 * d.rope.pitch;
                let arm = d.front_arc.radius;
                (
                    layout.suspension(),
                    Range::of(speed, |turn| {
                        arm * (d.front_arc.anchor + cycle.beam(turn).value) - length
                    }),
                )
            }
            CoordinateKind::Rod => (
                layout.rod(),
                Range::of(speed, |turn| {
                    cycle.tangent(turn).value + cycle.beam(turn).value - 0.25 * TAU
                }),
            ),
            CoordinateKind::Head => {
                let [face, ..] = site.faces else {
                    return;
                };
                let Some(shape) = face.anchor.first().map(|shape| shape.moves) else {
                    return;
                };
                let w = d.head.frequencies[0];
                let anchor = d.back_arc.anchor;
                let (s, c) = sin_cos(anchor);
                let end = shape[1] * c - shape[0] * s;
                // the wrapped rope presses with T / R and pulls with T where it ends
                let slow = Range::of(speed, |turn| {
                    let wrapped = cycle.tangent(turn).value - anchor;
                    let parts = 24;
                    let pressed: f64 = (0..parts)
                        .map(|k| {
                            let share = (f64::from(k) + 0.5) / f64::from(parts);
                            face.radial.value(anchor + share * wrapped, 0)
                        })
                        .sum();
                    let pressed = pressed * wrapped / f64::from(parts);
                    cycle.tension(turn) * (end - pressed) / (w * w)
                });
                // the mode swings at its own frequency, far faster than the crank moves it
                let rate = slow.reach * w;
                (layout.mode(0), Range { rate, ..slow })
            }
        };
        let probe = *self;
        extensions.add_line_force(index, AlongLine { probe, range });
    }
}

#[derive(Clone, Copy, Debug)]
struct AlongLine {
    probe: Probe,
    range: Range,
}

impl LineForce for AlongLine {
    fn along(&self, drive: &DriveState, place: f64, rate: f64) -> LineForceValue {
        let against = self.range.resistance(&self.probe, place, rate, drive.turn);
        LineForceValue {
            spring: -against.spring,
            non_conservative: -against.non_conservative,
            energy: against.energy,
            by_place: -against.by_place,
            by_rate: -against.by_rate,
        }
    }
}

/// Generic force along a rope, as a law of its cylinders' strain. Displacement and rate are taken from the
/// tension that corresponds to the strain.
///
/// Forms that are nonlinear in the rate use the rate of the ideal tension instead: cylinders vibrate against
/// each other faster than the load stretches them, and would stick or be torn apart.
#[derive(Clone, Debug)]
struct AlongRope {
    probe: Probe,
    tension: Range,
    /// Tension of the rope in the ideal mechanism as a function of the turn angle, up to a constant \[N\].
    slow: Splines,
    /// Sense of crank rotation, +1 or -1.
    sense: f64,
}

impl Axial for AlongRope {
    fn constant_force(&self, drive: &DriveState) -> Option<f64> {
        if matches!(
            self.probe.form,
            Form::Rate | Form::PlaceSquared | Form::PlaceCubed
        ) {
            return None;
        }
        let along = self.pull(&Strain {
            drive,
            strain: 0.0,
            rate: 0.0,
            stiffness: 1.0,
            memory: None,
        });
        Some(along.spring + along.non_conservative)
    }

    fn pull(&self, at: &Strain<'_>) -> LineForceValue {
        let (k, turn) = (at.stiffness, at.drive.turn);
        let place = at.strain * k;
        if matches!(self.probe.form, Form::SignOfRate | Form::RateSquared) {
            let slope = self.slow.jet(&self.slow.place(turn), 0).first;
            let rate = slope * self.sense * at.drive.pin_rate;
            let pull = self.tension.resistance(&self.probe, place, rate, turn);
            return LineForceValue {
                by_rate: 0.0,
                ..pull
            };
        }
        let rate = at.rate * k;
        let pull = self.tension.resistance(&self.probe, place, rate, turn);
        LineForceValue {
            energy: pull.energy / k,
            by_place: pull.by_place * k,
            by_rate: pull.by_rate * k,
            ..pull
        }
    }
}
