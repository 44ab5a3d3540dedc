//! A gauge feels what its partner on the other cheek measures: `s_i + x_i s_j`, partners 1 and 3,
//! 2 and 4. Wrong placement and misalignment mix the same two components.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::hook::{Effect, Hooks, Reading, Sampled, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "gauge_cross_talk",
        "Cross-talk between the gauges of the two pins",
    )
    .at("gauge", Place::Gauge)
    .sizes(
        ["into_1", "into_2", "into_3", "into_4"],
        Unit::One,
        0.05,
        [-0.5, 0.5],
    )
    .builds(|v| CrossTalk {
        into: v.each(["into_1", "into_2", "into_3", "into_4"]),
    })
}

#[derive(Clone, Copy, Debug)]
struct CrossTalk {
    into: [f64; 4],
}

impl Effect for CrossTalk {
    fn install(&self, _: &Site<'_>, hooks: &mut Hooks) {
        hooks.add_reading(*self);
    }
}

impl Reading for CrossTalk {
    fn sample(&self, _: &Sampled, stress: &mut [f64; 4]) {
        let own = *stress;
        for (k, stress) in stress.iter_mut().enumerate() {
            *stress += self.into[k] * own[(k + 2) % 4];
        }
    }
}
