//! Zeros drift over the revolution, as a cheek warms in the sun: `s + k t / t_rev`.
//!
//! A saw-tooth in the averaged record, with its jump at the mark.
//!
//! Source: Hoffmann, *An Introduction to Measurements using Strain Gages* (1989).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::hook::{Effect, Hooks, Reading, Sampled, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("gauge_drift", "Drift of the gauges over a revolution")
        .at("gauge", Place::Gauge)
        .sizes(
            ["drift_1", "drift_2", "drift_3", "drift_4"],
            Unit::MegapascalPerRevolution,
            0.5,
            [-20.0, 20.0],
        )
        .builds(|v| Drift {
            drift: v.each(["drift_1", "drift_2", "drift_3", "drift_4"]),
        })
}

#[derive(Clone, Copy, Debug)]
struct Drift {
    drift: [f64; 4],
}

impl Effect for Drift {
    fn install(&self, _: &Site<'_>, hooks: &mut Hooks) {
        hooks.add_reading(*self);
    }
}

impl Reading for Drift {
    fn sample(&self, at: &Sampled, stress: &mut [f64; 4]) {
        for (stress, drift) in stress.iter_mut().zip(self.drift) {
            *stress += drift * at.elapsed;
        }
    }
}
