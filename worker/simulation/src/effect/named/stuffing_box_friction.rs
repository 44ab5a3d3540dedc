//! Friction of the stuffing box that the load cell does not measure: `F - F_s sign(v)` on the suspension
//! point, with the sign regularised as `tanh(v / v_0)`, since packing deforms before it slides.
//!
//! Source: the law: Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994); packings: Takacs,
//! *Sucker-Rod Pumping Handbook* (2015).
use crate::drive::DriveState;
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::extension::{Effect, Extensions, LineForce, LineForceValue, Site, dry_friction};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("stuffing_box_friction", "Friction of the stuffing box that the load cell does not measure")
        .with_location("suspension", Place::Dynamics)
        .size("force", Unit::Newton, 800.0, [0.0, 2e4])
        // at which three quarters of the friction are there; the stroke reaches 1 m/s
        .shape("creep", Unit::MetrePerSecond, 5e-3, [1e-3, 0.3])
        .with_constructor(|v| Packing {
            force: v.get("force"),
            creep: v.get("creep"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Packing {
    force: f64,
    creep: f64,
}

impl Effect for Packing {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_line_force(site.layout.suspension(), *self);
    }
}

impl LineForce for Packing {
    fn along(&self, _: &DriveState, _: f64, rate: f64) -> LineForceValue {
        dry_friction(self.force, rate, self.creep)
    }
}
