//! Phase error of the counterweight, or a deviation of its moment.
//!
//! Since the crank motion is prescribed, the counterweight acts only through the slip of the motor: this
//! effect is the change of the crank speed ripple that the deviation causes at the slip of a usual motor. The
//! ripple itself is a separate effect (`crank_speed_ripple`). The slip is no shape parameter, since it would
//! only multiply phase and moment, and a record determines only the product.
//!
//! Source: counterbalance moment with its phase angle: API Spec 11E.
use super::crank_speed_ripple::{RATED, sampled, warp};
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::extension::{Effect, Extensions, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "counterweight_phase",
        "Phase or moment of the counterweight, visible through the slip of the motor",
    )
    .with_location("crank", Place::Drive)
    .size("phase", Unit::Degree, 5.0, [-45.0, 45.0])
    .size("moment", Unit::NewtonMetre, 5000.0, [-5e4, 5e4])
    .with_constructor(|v| Counterweight {
        phase: v.get("phase"),
        moment: v.get("moment"),
    })
}

#[derive(Clone, Copy, Debug)]
struct Counterweight {
    phase: f64,
    moment: f64,
}

/// Slip of the motor at [`RATED`] torque \[1\].
const SLIP: f64 = 0.0267;

impl Effect for Counterweight {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let crank = &site.description.crank;
        let (phase, moment) = (crank.counterweight_phase, crank.counterweight_moment);
        let slow = sampled(|turn| {
            let now = site
                .cycle
                .torque(turn, phase + self.phase, moment + self.moment);
            SLIP / RATED * (now - site.cycle.torque(turn, phase, moment))
        });
        extensions.add_warp(warp(&slow));
    }
}
