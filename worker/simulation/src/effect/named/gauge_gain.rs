//! A gauge reads too much or too little: `(1 + g) s`, by its factor, its leads, its amplifier, its
//! place.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::hook::{Effect, Hooks, Reading, Sampled, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("gauge_gain", "Gain of the gauges")
        .at("gauge", Place::Gauge)
        .sizes(
            ["gain_1", "gain_2", "gain_3", "gain_4"],
            Unit::One,
            0.05,
            [-0.5, 0.5],
        )
        .builds(|v| Gain {
            gain: v.each(["gain_1", "gain_2", "gain_3", "gain_4"]),
        })
}

#[derive(Clone, Copy, Debug)]
struct Gain {
    gain: [f64; 4],
}

impl Effect for Gain {
    fn install(&self, _: &Site<'_>, hooks: &mut Hooks) {
        hooks.add_reading(*self);
    }
}

impl Reading for Gain {
    fn sample(&self, _: &Sampled, stress: &mut [f64; 4]) {
        for (stress, gain) in stress.iter_mut().zip(self.gain) {
            *stress *= 1.0 + gain;
        }
    }
}
