//! Gain errors of the gauges, `(1 + g) s`, from gauge factor, leads, amplifier or position.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("gauge_gain", "Gain of the gauges")
        .with_location("gauge", Place::Gauge)
        .sizes(
            ["gain_1", "gain_2", "gain_3", "gain_4"],
            Unit::One,
            0.05,
            [-0.5, 0.5],
        )
        .with_reading(|v, _, stress| {
            for (stress, gain) in stress.iter_mut().zip(v.in_order()) {
                *stress *= 1.0 + gain;
            }
        })
}
