//! A gauge reads too much or too little: `(1 + g) s`, by its factor, its leads, its amplifier, its
//! place.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks, Reading, Sampled};
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("gauge_gain"),
    title: Cow::Borrowed("Gain of the gauges"),
    joint: "gauge",
    place: Place::Gauge,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("gain_1", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("gain_2", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("gain_3", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("gain_4", Unit::One, 0.05, [-0.5, 0.5]),
    ]),
    build: Build::Named(|v| {
        Box::new(Gain {
            gain: [v[0], v[1], v[2], v[3]],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Gain {
    gain: [f64; 4],
}

impl Effect for Gain {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.readings.push(Arc::new(*self));
    }
}

impl Reading for Gain {
    fn sample(&self, _: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
        for (stress, gain) in stress.iter_mut().zip(self.gain) {
            *stress *= 1.0 + gain;
        }
    }
}
