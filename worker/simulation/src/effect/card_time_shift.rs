//! The load card lies wrongly in time: `F(phi) -> F(phi - w t)`, the motion stays as it is.
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::math::spline::Splines;
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("card_time_shift"),
    title: Cow::Borrowed("Load card shifted in time against the crank"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("time", Unit::Second, 0.1, [-1.0, 1.0])]),
    build: Build::Named(|v| Box::new(Shift { time: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Shift {
    /// By how much the load comes later than the card says \[s\].
    time: f64,
}

impl Effect for Shift {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let step = std::f64::consts::TAU / d.card.len() as f64;
        let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
        let behind = self.time * d.crank.speed;
        for (i, load) in d.card.iter_mut().enumerate() {
            *load = card.value(step * i as f64 - behind, 0);
        }
    }
}
