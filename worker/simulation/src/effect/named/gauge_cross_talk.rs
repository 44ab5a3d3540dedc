//! Cross-talk from a gauge's partner on the other cheek: `s_i + x_i s_j`, partners 1 and 3, 2 and 4.
//! Misplacement and misalignment of a gauge mix the same two components.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "gauge_cross_talk",
        "Cross-talk between the gauges of the two pins",
    )
    .with_location("gauge", Place::Gauge)
    .sizes(
        ["into_1", "into_2", "into_3", "into_4"],
        Unit::One,
        0.05,
        [-0.5, 0.5],
    )
    .with_reading(|v, _, stress| {
        let own = *stress;
        for (k, into) in v.in_order().enumerate() {
            stress[k] += into * own[(k + 2) % 4];
        }
    })
}
