//! Local wear of the back head's surface, a groove or (negative) a weld seam: `h(psi) - depth exp(-((psi -
//! psi_0) / r)^2)`, with `r` such that `width` is the full width at half depth.
//!
//! The rope passes the same position twice per revolution, winding on and off.
//!
//! Source: the lever arm is geometry; arms of pumping units: Svinos, SPE 12201 (1983).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::extension::{Effect, Extensions, Hollow, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("head_profile_wear", "Local wear of the back head's surface")
        .with_location("back_head", Place::Dynamics)
        .size("depth", Unit::Metre, 0.004, [-0.02, 0.03])
        .shape("centre", Unit::Degree, 165.0, [130.0, 215.0])
        .shape("width", Unit::Degree, 12.0, [3.0, 40.0])
        .with_constructor(|v| Wear {
            depth: v.get("depth"),
            centre: v.get("centre"),
            width: v.get("width"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Wear {
    depth: f64,
    centre: f64,
    width: f64,
}

/// Ratio `2 sqrt(ln 2)` of the full width at half depth to the distance at which the depth has fallen to 1/e.
const HALF_WIDTH: f64 = 1.665_109_222_315_395_4;

impl Effect for Wear {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_hollow(Hollow {
            depth: self.depth,
            centre: self.centre,
            reach: self.width / HALF_WIDTH,
        });
    }
}
