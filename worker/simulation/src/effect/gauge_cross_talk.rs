//! A gauge feels what its partner on the other cheek measures: `s_i + x_i s_j`, partners 1 and 3,
//! 2 and 4. Wrong placement and misalignment mix the same two components.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks, Reading, Sampled};
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("gauge_cross_talk"),
    title: Cow::Borrowed("Cross-talk between the gauges of the two pins"),
    joint: "gauge",
    place: Place::Gauge,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("into_1", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("into_2", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("into_3", Unit::One, 0.05, [-0.5, 0.5]),
        Parameter::size("into_4", Unit::One, 0.05, [-0.5, 0.5]),
    ]),
    build: Build::Named(|v| {
        Box::new(CrossTalk {
            into: [v[0], v[1], v[2], v[3]],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct CrossTalk {
    into: [f64; 4],
}

impl Effect for CrossTalk {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.readings.push(Arc::new(*self));
    }
}

impl Reading for CrossTalk {
    fn sample(&self, _: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
        let own = *stress;
        for (k, stress) in stress.iter_mut().enumerate() {
            *stress += self.into[k] * own[(k + 2) % 4];
        }
    }
}
