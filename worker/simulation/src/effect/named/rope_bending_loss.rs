//! Bending loss of the back rope as it winds on and off the back head (capstan loss).
//!
//! The tension that pulls the head is `T (1 -+ e)` as the rope winds on or off, so that the same moment needs
//! `dT = -e T sign(psi')`: a couple `M = e T h sign(psi')` on the head, with `psi` the angle of the tangent
//! point on it. The couple changes sign where the winding reverses, which is not at the dead centres; the
//! sign is regularised as `tanh(psi' / w_0)`, since the wires slip one after another. Tension, arm and speed
//! of winding are those of the ideal mechanism.
//!
//! Source: efficiency of ropes over sheaves: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use crate::drive::DriveState;
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::tanh;
use crate::model::cycle::Cycle;
use crate::model::extension::{Effect, Extensions, LineForce, LineForceValue, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("rope_bending_loss", "Bending loss of the back rope on its head")
        .with_location("back_rope", Place::Dynamics)
        .size("loss", Unit::One, 0.015, [0.0, 0.1])
        // speed of winding at which three quarters of the loss are there; it reaches 0.5 rad/s
        .shape("creep", Unit::RadianPerSecond, 1e-2, [1e-3, 0.2])
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
        let couple = Couple {
            law: *self,
            cycle: site.cycle.clone(),
        };
        extensions.add_line_force(site.layout.beam(), couple);
    }
}

#[derive(Clone, Debug)]
struct Couple {
    law: Loss,
    cycle: Cycle,
}

impl LineForce for Couple {
    fn along(&self, drive: &DriveState, _: f64, _: f64) -> LineForceValue {
        let turning = self.cycle.crank().sense * drive.pin_rate;
        let winding = self.cycle.tangent(drive.turn).first * turning;
        let pull = self.cycle.tension(drive.turn) * self.cycle.arm(drive.turn);
        LineForceValue {
            non_conservative: self.law.loss * pull * tanh(winding / self.law.creep),
            ..LineForceValue::default()
        }
    }
}
