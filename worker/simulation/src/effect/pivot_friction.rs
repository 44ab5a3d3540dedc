//! Friction of the saddle bearing: `M = [M_c (1 + (r - 1) exp(-(w / w_s)^2)) + k |w|] sign(w)`.
//!
//! Coulomb friction with Stribeck's rise towards rest, and a viscous part; `tanh(w / w_0)` for the
//! sign.
//!
//! Source: Armstrong-Hélouvry, Dupont and Canudas de Wit, "A survey of models, analysis tools and
//! compensation methods for the control of machines with friction", Automatica 30 (1994).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Along, Cycle, Effect, Hooks, LineForce};
use crate::drive::DriveState;
use crate::math::elementary::{exp, tanh};
use crate::model::Machine;
use std::borrow::Cow;
use std::sync::Arc;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("pivot_friction"),
    title: Cow::Borrowed("Friction of the saddle bearing"),
    joint: "saddle",
    place: Place::Dynamics,
    generic: false,
    parameters: Cow::Borrowed(&[
        Parameter::size("moment", Unit::NewtonMetre, 1500.0, [0.0, 3e4]),
        Parameter::size(
            "viscous",
            Unit::NewtonMetreSecondPerRadian,
            5000.0,
            [0.0, 2e5],
        ),
        Parameter::shape("stribeck_ratio", Unit::One, 1.2, [1.0, 3.0]),
        Parameter::shape("stribeck_speed", Unit::RadianPerSecond, 0.02, [2e-3, 0.3]),
        // at which three quarters of the friction are there; the beam reaches 0.3 rad/s
        Parameter::shape("creep", Unit::RadianPerSecond, 2e-3, [5e-4, 0.1]),
    ]),
    build: Build::Named(|v| {
        Box::new(Bearing {
            moment: v[0],
            viscous: v[1],
            ratio: v[2],
            speed: v[3],
            creep: v[4],
        })
    }),
};

#[derive(Clone, Copy, Debug)]
struct Bearing {
    moment: f64,
    viscous: f64,
    ratio: f64,
    speed: f64,
    creep: f64,
}

impl Effect for Bearing {
    fn install(&self, machine: &Machine, _: &Cycle, hooks: &mut Hooks) {
        hooks.forces.push(Arc::new(Line {
            law: *self,
            beam: machine.layout.beam(),
        }));
    }
}

#[derive(Clone, Copy, Debug)]
struct Line {
    law: Bearing,
    beam: usize,
}

impl LineForce for Line {
    fn coordinate(&self) -> usize {
        self.beam
    }

    fn along(&self, _: &DriveState, _: f64, rate: f64) -> Along {
        let Bearing {
            moment,
            viscous,
            ratio,
            speed,
            creep,
        } = self.law;
        let t = tanh(rate / creep);
        let u = rate / speed;
        let rise = (ratio - 1.0) * exp(-(u * u));
        Along {
            other: -moment * (1.0 + rise) * t - viscous * rate,
            by_rate: -moment * ((1.0 + rise) * (1.0 - t * t) / creep - rise * t * 2.0 * u / speed)
                - viscous,
            ..Along::default()
        }
    }
}
