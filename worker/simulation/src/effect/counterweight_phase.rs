//! The counterweight stands before or behind its place, or has another moment.
//!
//! Under a prescribed crank that shows only where the motor slips: this effect is the difference that
//! the counterweight makes to the ripple of the crank's speed, with a slip of its own, so that it
//! can be told apart from the ripple itself.
//!
//! Source: counterbalance moment with its phase angle: API Spec 11E.
use super::crank_speed_ripple::{RATED, sampled, warp};
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect, Hooks};
use crate::model::Machine;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("counterweight_phase"),
    title: Cow::Borrowed(
        "Phase or moment of the counterweight, seen through the slip of the motor",
    ),
    joint: "crank",
    place: Place::Drive,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("phase", Unit::Degree, 5.0, [-45.0, 45.0]),
        Parameter::size("moment", Unit::NewtonMetre, 5000.0, [-5e4, 5e4]),
        Parameter::shape("slip", Unit::One, 0.0267, [1e-3, 0.12]),
    ]),
    build: Build::Named(|v| {
        Box::new(Counterweight {
            phase: v[0],
            moment: v[1],
            slope: v[2] / RATED,
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Counterweight {
    phase: f64,
    moment: f64,
    /// Loss of speed per torque [1/(N m)].
    slope: f64,
}

impl Effect for Counterweight {
    fn install(&self, machine: &Machine, cycle: &Cycle, hooks: &mut Hooks) {
        let crank = &machine.description.crank;
        let (phase, moment) = (crank.counterweight_phase, crank.counterweight_moment);
        let slow = sampled(|turn| {
            let now = cycle.torque(turn, phase + self.phase, moment + self.moment);
            self.slope * (now - cycle.torque(turn, phase, moment))
        });
        hooks.warps.push(warp(&slow));
    }
}
