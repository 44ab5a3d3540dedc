//! Poses and loads of a chain at the last evaluation of its forces.
use super::parts::Chain;
use super::points::Points;
use crate::element::bushing::LinkLoad;
use crate::math::spline::sum::Spread;
use crate::model::hook::axial::Memory;
use crate::model::layout::Motion;
use crate::model::pose::{PlanePose, Pose};
use nalgebra::Vector2;

/// Poses and loads of a chain at the last evaluation of its forces; allocated once.
#[derive(Clone, Debug)]
pub struct ChainState {
    /// Pose of each cylinder that moves in space; empty where they move in the plane.
    pub poses: Vec<Pose>,
    /// Pose of each cylinder that moves in the plane; empty where they move in space.
    pub plane: Vec<PlanePose>,
    /// Angles of those \[rad\], their sines and cosines.
    pub(super) turns: [Vec<f64>; 3],
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
    /// What laws along the rope remember of the last accepted step, joint by joint and law by law;
    /// empty where none has a past, or before the run has begun to move.
    pub memory: Vec<Memory>,
}

impl ChainState {
    /// Buffers for a chain.
    pub fn new(chain: &Chain) -> Self {
        let (poses, plane) = match chain.motion {
            Motion::Plane => (0, chain.count),
            Motion::Space => (chain.count, 0),
        };
        Self {
            poses: vec![Pose::new(&[0.0; 6], &[0.0; 6]); poses],
            plane: vec![PlanePose::new(&[0.0; 3], &[0.0; 3], Vector2::x()); plane],
            turns: std::array::from_fn(|_| vec![0.0; plane]),
            joints: vec![LinkLoad::none(); chain.count + 1],
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
