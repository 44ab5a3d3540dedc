//! The rod string answers the motion that the card does not know: `F + Z (v - v_m)`.
//!
//! The card was measured while the suspension point moved with `v_m`, here that of the ideal
//! mechanism; a rope that swings the suspension point drives a wave down the rods, whose impedance
//! is `Z = sqrt(E A mu)`, 20.5 kN s/m for 25 mm rods.
//!
//! Source: characteristic impedance of a rod: Graff, *Wave Motion in Elastic Solids* (1975); the
//! string: Gibbs, JPT 15 (1963).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Along, Cycle, Effect, Hooks, LineForce};
use crate::drive::DriveState;
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("rod_string_reaction"),
    title: Cow::Borrowed("Reaction of the rod string to motion that the card does not know"),
    joint: "suspension",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size(
        "impedance",
        Unit::NewtonSecondPerMetre,
        20500.0,
        [0.0, 1e5],
    )]),
    build: Build::Named(|v| Box::new(Rods { impedance: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Rods {
    impedance: f64,
}

impl Effect for Rods {
    fn install(&self, machine: &Machine, cycle: &Cycle, hooks: &mut Hooks) {
        hooks.forces.push(Arc::new(Wave {
            impedance: self.impedance,
            arm: machine.description.front_arc.radius,
            cycle: cycle.clone(),
            suspension: machine.layout.suspension(),
        }));
    }
}

#[derive(Clone, Debug)]
struct Wave {
    impedance: f64,
    arm: f64,
    cycle: Cycle,
    suspension: usize,
}

impl LineForce for Wave {
    fn coordinate(&self) -> usize {
        self.suspension
    }

    fn along(&self, drive: &DriveState, _: f64, rate: f64) -> Along {
        let turning = self.cycle.crank().sense * drive.pin_rate;
        let known = self.arm * self.cycle.beam(drive.turn).first * turning;
        Along {
            other: -self.impedance * (rate - known),
            by_rate: -self.impedance,
            ..Along::default()
        }
    }
}
