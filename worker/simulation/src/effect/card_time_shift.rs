//! The load card is late: the machine feels at `phi` what the card holds at `phi + w t`, the motion stays
//! as it is.
//!
//! Source: a card is load over position at the same moment: Gibbs and Neely, "Computer Diagnosis of
//! Down-Hole Conditions in Sucker Rod Pumping Wells", JPT 18 (1966).
use super::Effect;
use super::descriptor::{Build, Descriptor, Parameter, Place, Unit};
use crate::math::spline::Splines;
use crate::model::description::Description;
use std::borrow::Cow;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    id: Cow::Borrowed("card_time_shift"),
    title: Cow::Borrowed("Load card late against the crank"),
    joint: "load_cell",
    place: Place::Load,
    generic: false,
    parameters: Cow::Borrowed(&[Parameter::size("time", Unit::Second, 0.1, [-1.0, 1.0])]),
    build: Build::Named(|v| Box::new(Shift { time: v[0] })),
};

#[derive(Clone, Copy, Debug)]
struct Shift {
    /// By how much the card is later than the load \[s\].
    time: f64,
}

impl Effect for Shift {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let step = std::f64::consts::TAU / d.card.len() as f64;
        let card = Splines::periodic(0.0, step, std::slice::from_ref(&d.card));
        let late = self.time * d.crank.speed;
        for (i, load) in d.card.iter_mut().enumerate() {
            *load = card.value(step * i as f64 + late, 0);
        }
    }
}
