//! Constant data of a chain of cylinders, and the joint laws that hold at one instant.
use crate::element::bushing::{Bushing, Marker};
use crate::model::contact::{GAUSS, POINTS};
use crate::model::extension::axial::AxialLaws;
use crate::model::layout::Motion;

/// Chain of equal cylinders (a rope): its position among the unknowns and the properties of its cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// Index of the matrix block of the chain's first cylinder.
    pub first: usize,
    /// Number of cylinders, at least one.
    pub count: usize,
    /// Kind of motion, in the plane or in space, which determines the coordinates of a cylinder.
    pub motion: Motion,
    /// Length of a cylinder \[m\].
    pub pitch: f64,
    /// Mass of a cylinder \[kg\].
    pub mass: f64,
    /// Moments of inertia of a cylinder about its axis and about a transverse axis [kg m2].
    pub inertia: [f64; 2],
    /// Contact evaluation points: positions along a cylinder in half lengths, and their shares of the contact
    /// coefficients; a point with zero share is ignored.
    pub contact_points: &'static [(f64, f64); POINTS],
}

impl Chain {
    /// Creates a chain of solid cylinders with a diameter \[m\], a length \[m\] and a density [kg/m3].
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

    /// Returns the index range of the cylinders' coordinates in a vector of unknowns.
    pub(crate) const fn range(&self) -> std::ops::Range<usize> {
        let width = self.motion.width();
        self.first * width..(self.first + self.count) * width
    }
}

/// End of a chain that is held by another body: marker on that body and force law of the joint.
#[derive(Clone, Copy, Debug)]
pub struct EndJoint<'a> {
    /// Marker on the body that holds the end.
    pub marker: Marker,
    /// Force law of the end joint.
    pub law: &'a Bushing,
    /// Whether the joint is pinned: its law's axis is then a pin along the holding body's z axis instead of
    /// the chain's axis.
    pub pinned: bool,
}

/// Joints of a chain with their force laws, at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Joints<'a> {
    /// Force law of the joints between two cylinders.
    pub inner: &'a Bushing,
    /// Joint that holds the first cylinder; `None` if that end is free.
    pub base: Option<EndJoint<'a>>,
    /// Joint that holds the last cylinder; `None` if that end is free.
    pub head: Option<EndJoint<'a>>,
    /// Axial effect laws that act between the cylinders; `None` without any.
    pub axial: Option<AxialLaws<'a>>,
}
