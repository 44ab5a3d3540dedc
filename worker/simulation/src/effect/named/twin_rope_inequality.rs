//! Unequal lengths of the two parallel back ropes, which share the tension unequally: `T / 2 (1 +- e)`, `e =
//! dL EA / (2 T L)`.
//!
//! `EA` and `T` are those of both ropes together, `L` is the back rope's length. The stress at the gauges on
//! one cheek (1, 2) is multiplied by `1 + e`, on the other (3, 4) by `1 - e`. A slack rope carries nothing:
//! `|e| <= 1`.
//!
//! For a description with twin ropes the length of the back rope at +z is changed instead, and the sharing
//! follows from the simulation.
//!
//! Source: sharing among parallel ropes: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::description::Description;
use crate::model::extension::{Effect, Extensions, Reading, SampleState, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "twin_rope_inequality",
        "Unequal lengths of the twin back ropes",
    )
    .with_location("back_rope", Place::Gauge)
    .size("length", Unit::Metre, 0.002, [-0.05, 0.05])
    .with_constructor(|v| Twins {
        length: v.get("length"),
    })
}

#[derive(Clone, Copy, Debug)]
struct Twins {
    length: f64,
}

impl Effect for Twins {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        if let Some(twins) = &mut d.twins {
            twins.longer[0] += self.length;
        }
    }

    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        if site.description.twins.is_none() {
            let rope = &site.description.rope;
            extensions.add_reading(Sharing {
                difference: self.length,
                pitch: rope.pitch,
                length: rope.back as f64 * rope.pitch,
            });
        }
    }
}

/// Multiplier of gauge stress due to unequal sharing of the tension between two parallel ropes of different
/// length.
#[derive(Clone, Copy, Debug)]
struct Sharing {
    /// Difference of the two rope lengths \[m\]; `length` is the back rope's length \[m\].
    difference: f64,
    length: f64,
    /// Length of rope represented by one joint \[m\].
    pitch: f64,
}

impl Reading for Sharing {
    fn sample(&self, at: &SampleState, stress: &mut [f64; 4]) {
        let stiffness = at.joint_stiffness * self.pitch;
        let tension = at.back_tension;
        let difference = 0.5 * self.difference * stiffness / self.length;
        let e = if difference.abs() < tension {
            difference / tension
        } else {
            difference.signum()
        };
        for (stress, side) in stress.iter_mut().zip([e, e, -e, -e]) {
            *stress *= 1.0 + side;
        }
    }
}
