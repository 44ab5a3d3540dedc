//! What a chain is made of, and what holds it at an instant.
use crate::element::bushing::{Bushing, Marker};
use crate::model::contact::{GAUSS, POINTS};
use crate::model::hook::axial::AxialLaws;
use crate::model::layout::Motion;

/// The blocks that a chain takes among the unknowns, and what its cylinders are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// Block of the first cylinder.
    pub first: usize,
    /// Number of cylinders, at least one.
    pub count: usize,
    /// Coordinates of a cylinder.
    pub motion: Motion,
    /// Length of a cylinder \[m\].
    pub pitch: f64,
    /// Mass of a cylinder \[kg\].
    pub mass: f64,
    /// Moments of inertia of a cylinder along and across its axis [kg m2].
    pub inertia: [f64; 2],
    /// Where along a cylinder its contact is evaluated, in half lengths, and the shares of its
    /// coefficients; what has no share does not count.
    pub contact_points: &'static [(f64, f64); POINTS],
}

impl Chain {
    /// Solid cylinders of a diameter \[m\], a length \[m\] and a density [kg/m3].
    pub fn solid(first: usize, count: usize, diameter: f64, pitch: f64, density: f64) -> Self {
        let radius = 0.5 * diameter;
        let mass = density * std::f64::consts::PI * radius * radius * pitch;
        Self {
            first,
            count,
            motion: Motion::Space,
            pitch,
            mass,
            inertia: [
                0.5 * mass * radius * radius,
                mass * (3.0 * radius * radius + pitch * pitch) / 12.0,
            ],
            contact_points: &GAUSS,
        }
    }

    /// Where the cylinders' coordinates lie in a vector of unknowns.
    pub(crate) const fn range(&self) -> std::ops::Range<usize> {
        let width = self.motion.width();
        self.first * width..(self.first + self.count) * width
    }
}

/// An end of a chain that is held: the marker on the body that holds it, and the joint's law.
#[derive(Clone, Copy, Debug)]
pub struct Held<'a> {
    /// Marker on the holding body.
    pub marker: Marker,
    /// Law of the joint.
    pub law: &'a Bushing,
    /// Whether the law's axis is a pin along the holding body's z axis in place of the chain's own.
    pub pinned: bool,
}

/// The joints of a chain at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Joints<'a> {
    /// Law between two cylinders.
    pub inner: &'a Bushing,
    /// What holds the first cylinder, if anything does.
    pub base: Option<Held<'a>>,
    /// What holds the last cylinder, if anything does.
    pub head: Option<Held<'a>>,
    /// Laws of effects along the rope, between its cylinders.
    pub axial: Option<AxialLaws<'a>>,
}
