//! Gas in the pump must be compressed before the travelling valve opens: the load falls later and more
//! gently, `F(phi) -> F(phi - d(phi))`.
//!
//! The delay grows from top dead centre on, is greatest 60 deg later and gone after 120 deg:
//! `d = d_0 sin^2(pi (phi - phi_top) / 120 deg)`.
//!
//! Source: Takacs, *Sucker-Rod Pumping Handbook* (2015).
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use super::{Cycle, Effect};
use crate::math::elementary::sin_cos;
use crate::math::spline::Splines;
use crate::model::description::Description;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("gas_interference"),
    title: Cow::Borrowed("Gas interference in the pump"),
    joint: "suspension",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("delay", Unit::Degree, 12.0, [0.0, 35.0])]),
    build: Build::Named(|v| Box::new(Gas { delay: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Gas {
    delay: f64,
}

/// Turn over which the load is late \[rad\].
const LATE: f64 = 120.0 * PI / 180.0;

impl Effect for Gas {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        // a mechanism that does not close is refused when the machine is built
        let Ok(cycle) = Cycle::of(d) else { return };
        let top = cycle.descent(0.0);
        let step = TAU / d.card.len() as f64;
        let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
        for (i, load) in d.card.iter_mut().enumerate() {
            let turn = step * i as f64;
            let since = turn - top;
            if since > 0.0 && since < LATE {
                let (s, _) = sin_cos(PI * since / LATE);
                *load = card.value(turn - self.delay * s * s, 0);
            }
        }
    }
}
