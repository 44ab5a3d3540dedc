//! Bending loss of the front rope as it winds on and off the front head: `M = e T A sign(theta')`.
//!
//! The tension is that of the load alone, from the card and the ideal motion. The rope always leaves the arc
//! at the height of its centre, so it winds with the rotation of the beam.
//!
//! Source: efficiency of ropes over sheaves: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use crate::drive::DriveState;
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::extension::{Effect, Extensions, LineForce, LineForceValue, Site, dry_friction};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("front_rope_bending_loss", "Bending loss of the front rope on its head")
        .with_location("front_rope", Place::Dynamics)
        .size("loss", Unit::One, 0.005, [0.0, 0.1])
        // at which three quarters of the loss are there; the beam reaches 0.3 rad/s
        .shape("creep", Unit::RadianPerSecond, 2e-3, [5e-4, 0.1])
        .with_constructor(|v| Loss {
            loss: v.get("loss"),
            creep: v.get("creep"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Loss {
    loss: f64,
    creep: f64,
}

impl Effect for Loss {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let d = &site.description;
        let couple = Couple {
            arm: self.loss * d.front_arc.radius,
            creep: self.creep,
            weight: d.suspension_mass * d.gravity,
        };
        extensions.add_line_force(site.layout.beam(), couple);
    }
}

#[derive(Clone, Copy, Debug)]
struct Couple {
    arm: f64,
    creep: f64,
    weight: f64,
}

impl LineForce for Couple {
    fn along(&self, drive: &DriveState, _: f64, rate: f64) -> LineForceValue {
        dry_friction(self.arm * (drive.load + self.weight), rate, self.creep)
    }
}
