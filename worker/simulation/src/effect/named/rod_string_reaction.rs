//! Reaction of the rod string to motion that the card does not contain: `F + Z (v - v_m)`.
//!
//! The card was measured while the suspension point moved with `v_m`, taken as that of the ideal mechanism; a
//! rope vibration that moves the suspension point sends a wave down the rods, whose impedance is `Z = sqrt(E
//! A mu)`, 20.5 kN s/m for 25 mm rods.
//!
//! Source: characteristic impedance of a rod: Graff, *Wave Motion in Elastic Solids* (1975); the string:
//! Gibbs, JPT 15 (1963).
use crate::drive::DriveState;
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::model::cycle::Cycle;
use crate::model::extension::{Effect, Extensions, LineForce, LineForceValue, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "rod_string_reaction",
        "Reaction of the rod string to motion that the card does not contain",
    )
    .with_location("suspension", Place::Dynamics)
    .size("impedance", Unit::NewtonSecondPerMetre, 20500.0, [0.0, 1e5])
    .with_constructor(|v| Rods {
        impedance: v.get("impedance"),
    })
}

#[derive(Clone, Copy, Debug)]
struct Rods {
    impedance: f64,
}

impl Effect for Rods {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let wave = Wave {
            impedance: self.impedance,
            arm: site.description.front_arc.radius,
            cycle: site.cycle.clone(),
        };
        extensions.add_line_force(site.layout.suspension(), wave);
    }
}

#[derive(Clone, Debug)]
struct Wave {
    impedance: f64,
    arm: f64,
    cycle: Cycle,
}

impl LineForce for Wave {
    fn along(&self, drive: &DriveState, _: f64, rate: f64) -> LineForceValue {
        let turning = self.cycle.crank().sense * drive.pin_rate;
        let known = self.arm * self.cycle.beam(drive.turn).first * turning;
        LineForceValue {
            non_conservative: -self.impedance * (rate - known),
            by_rate: -self.impedance,
            ..LineForceValue::default()
        }
    }
}
