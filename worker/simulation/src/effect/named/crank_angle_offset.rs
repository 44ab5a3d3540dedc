//! Zero offset of the recorded crank angle: `sigma_m(phi) = sigma(phi + d)`, equal for all channels.
//!
//! Source: angles of a pumping unit: Svinos, "Exact Kinematic Analysis of Pumping Units", SPE 12201 (1983).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::extension::{Effect, Extensions, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "crank_angle_offset",
        "Zero offset of the recorded crank angle",
    )
    .with_location("crank", Place::Drive)
    .size("angle", Unit::Degree, 2.0, [-15.0, 15.0])
    .with_constructor(|v| Offset {
        angle: v.get("angle"),
    })
}

#[derive(Clone, Copy, Debug)]
struct Offset {
    angle: f64,
}

impl Effect for Offset {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.move_index(self.angle);
    }
}
