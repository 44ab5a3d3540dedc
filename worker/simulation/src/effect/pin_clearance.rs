//! Clearance in the pins that hold the back head: the load path switches where the head's push along
//! the beam turns round.
//!
//! The rope pushes the head along the beam with `f`, backwards or forwards in turn. When `f` changes
//! its sign the head shifts by the clearance and bears on the other side of the pin's hole, which
//! moves the stress in the steel beside it by a step: `s_i +- c_i g tanh(f / f_0)`, with `g` the
//! radial gap of pin A (gauges 1 and 2) or B (gauges 3 and 4) and `c_i` stress per gap. `f_0` is the
//! force over which the bearing side changes.
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks, Reading, Sampled};
use crate::math::elementary::{sin_cos, tanh};
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("pin_clearance"),
    title: Cow::Borrowed("Clearance of the pins that hold the back head"),
    joint: "pin_b",
    place: Place::Gauge,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("gap_a", Unit::Metre, 2e-4, [-2e-3, 2e-3]),
        Parameter::size("gap_b", Unit::Metre, 2e-4, [-2e-3, 2e-3]),
        Parameter::shape("force", Unit::Newton, 3000.0, [100.0, 5e4]),
        Parameter::shape("stress", Unit::MegapascalPerMetre, 6000.0, [500.0, 5e4]),
    ]),
    build: Build::Named(|v| {
        Box::new(Clearance {
            gap: [v[0], v[1]],
            force: v[2],
            stress: v[3],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Clearance {
    gap: [f64; 2],
    force: f64,
    stress: f64,
}

impl Effect for Clearance {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.readings.push(Arc::new(*self));
    }
}

impl Reading for Clearance {
    fn sample(&self, at: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
        let (s, c) = sin_cos(at.beam);
        let [x, y] = at.individual.head_push();
        let side = tanh((c * x + s * y) / self.force);
        for (k, stress) in stress.iter_mut().enumerate() {
            *stress += self.stress * self.gap[k / 2] * side;
        }
    }
}
