//! A chain of equal cylinders: its joints, its weight, its contact with one arc, and their tangent.
//!
//! The kernels of every rope, in a machine or alone on a test rig. A chain knows the markers that
//! hold its ends, not whose they are: what an end joint does to the body that holds it is that
//! body's business. Joint 0 is before the first cylinder, joint n behind the last; J is the marker
//! nearer to the chain's base, I the one nearer to its head.
mod axial;
mod contact;
mod contact_tangent;
mod energy;
mod forces;
mod inertia;
mod plane;
mod points;
mod tangent;

use crate::effect::{AxialLaws, Memory};
use crate::element::bushing::{Bushing, LinkLoad, Marker};
use crate::math::spline::sum::Spread;
use crate::model::contact::{GAUSS, POINTS};
use crate::model::layout::Motion;
use crate::model::pose::{PlanePose, Pose};
use nalgebra::{Matrix3, Vector2, Vector3};

pub use points::Points;
pub(crate) use tangent::{Column, EndTangent};

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

/// Poses and loads of a chain at the last evaluation of its forces; allocated once.
#[derive(Clone, Debug)]
pub struct ChainState {
    /// Pose of each cylinder that moves in space; empty where they move in the plane.
    pub poses: Vec<Pose>,
    /// Pose of each cylinder that moves in the plane; empty where they move in space.
    pub plane: Vec<PlanePose>,
    /// Angles of those \[rad\], their sines and cosines.
    turns: [Vec<f64>; 3],
    /// Load of each joint, one more than cylinders; zero where an end is free.
    pub joints: Vec<LinkLoad>,
    /// Contact force of each cylinder \[N\].
    pub contact: Vec<f64>,
    /// Points of contact of the last evaluation.
    pub points: Points,
    /// Contact forces on a deflected arc, spread over the knots of its shapes.
    pub pressure: Spread,
    /// Deepest penetration \[m\].
    pub deepest: f64,
    /// Power that the contact's damping takes \[W\].
    pub dissipated: f64,
    /// What laws along the rope remember of the last accepted step, joint by joint; empty where
    /// none has a past, or before the run has begun to move.
    pub memory: Vec<Memory>,
}

impl ChainState {
    /// Buffers for a chain.
    pub fn new(chain: &Chain) -> Self {
        let (poses, plane) = match chain.motion {
            Motion::Plane => (0, chain.count),
            Motion::Space => (chain.count, 0),
        };
        let none = LinkLoad {
            force: Vector3::zeros(),
            torque_i: Vector3::zeros(),
            torque_j: Vector3::zeros(),
            axial: 0.0,
            dissipated: 0.0,
        };
        Self {
            poses: vec![Pose::new(&[0.0; 6], &[0.0; 6]); poses],
            plane: vec![PlanePose::new(&[0.0; 3], &[0.0; 3], Vector2::x()); plane],
            turns: std::array::from_fn(|_| vec![0.0; plane]),
            joints: vec![none; chain.count + 1],
            contact: vec![0.0; chain.count],
            points: Points::new(chain),
            pressure: Spread::default(),
            deepest: 0.0,
            dissipated: 0.0,
            memory: Vec::new(),
        }
    }

    /// Pose of cylinder `j` in space.
    pub fn pose(&self, j: usize) -> Pose {
        self.plane
            .get(j)
            .map_or_else(|| self.poses[j], PlanePose::in_space)
    }

    /// Power that the damping of joints and contact takes \[W\].
    pub fn losses(&self) -> f64 {
        let joints = self.joints.iter().map(|load| load.dissipated);
        joints.sum::<f64>() + self.dissipated
    }

    /// Tension in a joint, positive where it pulls \[N\].
    pub fn tension(&self, joint: usize) -> f64 {
        -self.joints[joint].axial
    }
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

    /// Markers I and J of a joint and its law; nothing where an end is free. Between cylinders that
    /// move in the plane there are plane markers instead.
    fn link<'a>(
        &self,
        joint: usize,
        joints: &Joints<'a>,
        state: &ChainState,
    ) -> Option<([Marker; 2], &'a Bushing)> {
        let half = 0.5 * self.pitch;
        if joint == 0 {
            let held = joints.base?;
            let markers = [on_cylinder(&state.pose(0), -half), held.marker];
            return Some((held.turned(&markers), held.law));
        }
        if joint == self.count {
            let held = joints.head?;
            let j = on_cylinder(&state.pose(joint - 1), half);
            return Some((held.turned(&[held.marker, j]), held.law));
        }
        let j = on_cylinder(&state.poses[joint - 1], half);
        Some(([on_cylinder(&state.poses[joint], -half), j], joints.inner))
    }
}

impl Held<'_> {
    /// Markers of a joint with the axes that its law refers to.
    fn turned(&self, markers: &[Marker; 2]) -> [Marker; 2] {
        if !self.pinned {
            return *markers;
        }
        markers.map(|marker| {
            let [x, y, z] = [0, 1, 2].map(|k| marker.R.column(k).into_owned());
            Marker {
                R: Matrix3::from_columns(&[z, x, y]),
                ..marker
            }
        })
    }
}

fn on_cylinder(pose: &Pose, along: f64) -> Marker {
    Marker {
        p: pose.p,
        rho: pose.axis() * along,
        v: pose.v,
        w: pose.w,
        R: pose.R,
    }
}
