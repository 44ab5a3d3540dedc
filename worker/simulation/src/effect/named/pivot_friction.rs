//! Friction of the saddle bearing: `M = [M_c (1 + (r - 1) exp(-(w / w_s)^2)) + k |w|] sign(w)`.
//!
//! Coulomb friction with the Stribeck rise at low speed and a viscous part; the sign is regularised as
//! `tanh(w / w_0)`.
//!
//! Source: Armstrong-Hélouvry, Dupont and Canudas de Wit, "A survey of models, analysis tools and
//! compensation methods for the control of machines with friction", Automatica 30 (1994).
use crate::drive::DriveState;
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::{exp, tanh};
use crate::model::extension::{Effect, Extensions, LineForce, LineForceValue, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("pivot_friction", "Friction of the saddle bearing")
        .with_location("saddle", Place::Dynamics)
        .size("moment", Unit::NewtonMetre, 1500.0, [0.0, 3e4])
        .size("viscous", Unit::NewtonMetreSecondPerRadian, 5000.0, [0.0, 2e5])
        .shape("stribeck_ratio", Unit::One, 1.2, [1.0, 3.0])
        .shape("stribeck_speed", Unit::RadianPerSecond, 0.02, [2e-3, 0.3])
        // at which three quarters of the friction are there; the beam reaches 0.3 rad/s
        .shape("creep", Unit::RadianPerSecond, 2e-3, [5e-4, 0.1])
        .with_constructor(|v| Bearing {
            moment: v.get("moment"),
            viscous: v.get("viscous"),
            ratio: v.get("stribeck_ratio"),
            speed: v.get("stribeck_speed"),
            creep: v.get("creep"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Bearing {
    moment: f64,
    viscous: f64,
    ratio: f64,
    speed: f64,
    creep: f64,
}

impl Effect for Bearing {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_line_force(site.layout.beam(), *self);
    }
}

impl LineForce for Bearing {
    fn along(&self, _: &DriveState, _: f64, rate: f64) -> LineForceValue {
        let &Self {
            moment,
            viscous,
            ratio,
            speed,
            creep,
        } = self;
        let t = tanh(rate / creep);
        let u = rate / speed;
        let rise = (ratio - 1.0) * exp(-(u * u));
        LineForceValue {
            non_conservative: -moment * (1.0 + rise) * t - viscous * rate,
            by_rate: -moment * ((1.0 + rise) * (1.0 - t * t) / creep - rise * t * 2.0 * u / speed)
                - viscous,
            ..LineForceValue::default()
        }
    }
}
