//! Zero drift of the gauges over the revolution, as when the sun heats one cheek: `s + k t / t_rev`.
//!
//! In the averaged record the drift is a saw-tooth with its jump at the index mark.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("gauge_drift", "Drift of the gauges over a revolution")
        .with_location("gauge", Place::Gauge)
        .sizes(
            ["drift_1", "drift_2", "drift_3", "drift_4"],
            Unit::MegapascalPerRevolution,
            0.5,
            [-20.0, 20.0],
        )
        .with_reading(|v, elapsed, stress| {
            for (stress, drift) in stress.iter_mut().zip(v.in_order()) {
                *stress += drift * elapsed;
            }
        })
}
