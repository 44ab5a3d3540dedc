//! Zeros drift over the revolution, as a cheek warms in the sun: `s + k t / t_rev`.
//!
//! A saw-tooth in the averaged record, with its jump at the mark.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks, Reading, Sampled};
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("gauge_drift"),
    title: Cow::Borrowed("Drift of the gauges over a revolution"),
    joint: "gauge",
    place: Place::Gauge,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("drift_1", Unit::MegapascalPerRevolution, 0.5, [-20.0, 20.0]),
        Parameter::size("drift_2", Unit::MegapascalPerRevolution, 0.5, [-20.0, 20.0]),
        Parameter::size("drift_3", Unit::MegapascalPerRevolution, 0.5, [-20.0, 20.0]),
        Parameter::size("drift_4", Unit::MegapascalPerRevolution, 0.5, [-20.0, 20.0]),
    ]),
    build: Build::Named(|v| {
        Box::new(Drift {
            drift: [v[0], v[1], v[2], v[3]],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Drift {
    drift: [f64; 4],
}

impl Effect for Drift {
    fn install(&self, _: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.readings.push(Arc::new(*self));
    }
}

impl Reading for Drift {
    fn sample(&self, at: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
        for (stress, drift) in stress.iter_mut().zip(self.drift) {
            *stress += drift * at.elapsed;
        }
    }
}
