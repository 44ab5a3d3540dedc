//! Poses of a chain's cylinders and loads of its joints and contact at the last evaluation of its forces.
use super::parts::Chain;
use super::points::Points;
use crate::element::bushing::LinkLoad;
use crate::math::real::WIDEST;
use crate::math::spline::sum::KnotForces;
use crate::model::extension::axial::Memory;
use crate::model::layout::Motion;
use crate::model::pose::{PlanePoses, Pose};
use nalgebra::Vector3;

/// Poses of a chain's cylinders and loads of its joints and contact at the last evaluation of its forces;
/// buffers are allocated once.
#[derive(Clone, Debug)]
pub struct ChainState {
    /// Poses of the cylinders of a chain in space; empty for a chain in the plane.
    pub poses: Vec<Pose>,
    /// Poses of the cylinders of a chain in the plane; empty for a chain in space.
    pub plane: PlanePoses,
    /// Loads of all joints of the chain, one more than it has cylinders; zero for a free end, and for the
    /// joints between cylinders in the plane, whose loads are in `plane_joints`.
    pub joints: Vec<LinkLoad>,
    /// Loads of the joints between cylinders of a chain in the plane; empty for a chain in space.
    pub(super) plane_joints: PlaneLoads,
    /// Contact force of each cylinder \[N\].
    pub contact: Vec<f64>,
    /// Contact points of the chain at the last evaluation.
    pub points: Points,
    /// Contact forces on a flexible arc, distributed to the knots (grid points) of its mode shapes.
    pub pressure: KnotForces,
    /// Largest penetration of a contact point \[m\].
    pub deepest: f64,
    /// Power dissipated by the contact damping \[W\].
    pub dissipated: f64,
    /// Memory of history-dependent axial effect laws at the last accepted step, joint by joint and law by
    /// law; empty if no law has memory, or before the first step.
    pub memory: Vec<Memory>,
}

impl ChainState {
    /// Allocates the buffers for the state of a chain.
    pub fn new(chain: &Chain) -> Self {
        let (poses, plane) = match chain.motion {
            Motion::Plane => (0, chain.count),
            Motion::Space => (chain.count, 0),
        };
        Self {
            poses: vec![Pose::new(&[0.0; 6], &[0.0; 6]); poses],
            plane: PlanePoses::new(plane),
            joints: vec![LinkLoad::none(); chain.count + 1],
            plane_joints: PlaneLoads::new(plane.saturating_sub(1)),
            contact: vec![0.0; chain.count],
            points: Points::new(chain),
            pressure: KnotForces::default(),
            deepest: 0.0,
            dissipated: 0.0,
            memory: Vec::new(),
        }
    }

    /// Returns the pose of cylinder `j` in space.
    pub fn pose(&self, j: usize) -> Pose {
        if self.plane.is_empty() {
            self.poses[j]
        } else {
            self.plane.get(j).in_space()
        }
    }

    /// Returns the power dissipated by the joints and the contact of the chain \[W\].
    pub fn losses(&self) -> f64 {
        let joints = self.joints.iter().map(|load| load.dissipated);
        joints.sum::<f64>() + self.plane_joints.dissipated() + self.dissipated
    }

    /// Returns the tension in a joint of the chain \[N\], negative under compression.
    pub fn tension(&self, joint: usize) -> f64 {
        let between = joint
            .checked_sub(1)
            .and_then(|k| self.plane_joints.tension(k));
        between.unwrap_or_else(|| -self.joints[joint].axial)
    }

    /// Returns the force of a joint on the cylinder (or head) behind it \[N\].
    pub fn joint_force(&self, joint: usize) -> Vector3<f64> {
        let between = joint
            .checked_sub(1)
            .and_then(|k| self.plane_joints.force(k));
        between.unwrap_or_else(|| self.joints[joint].force)
    }
}

/// Loads of the joints between the cylinders of a chain in the plane, one array per quantity, padded for SIMD
/// lanes; the joint after cylinder `k` has index `k`.
#[derive(Clone, Debug, Default)]
pub(super) struct PlaneLoads {
    pub(super) count: usize,
    /// Forces on the cylinder behind the joint \[N\], and the torques on the cylinders behind and before it
    /// about their centres [N m].
    pub(super) force: [Vec<f64>; 2],
    pub(super) torque: [Vec<f64>; 2],
    /// Tensions \[N\]; the field `dissipated` holds the dissipated powers \[W\].
    pub(super) tension: Vec<f64>,
    pub(super) dissipated: Vec<f64>,
}

impl PlaneLoads {
    /// Allocates the loads of `count` joints.
    pub(super) fn new(count: usize) -> Self {
        let zeros = || vec![0.0; count.next_multiple_of(WIDEST)];
        Self {
            count,
            force: [zeros(), zeros()],
            torque: [zeros(), zeros()],
            tension: zeros(),
            dissipated: zeros(),
        }
    }

    /// Returns the power dissipated by all joints \[W\].
    pub(super) fn dissipated(&self) -> f64 {
        self.dissipated[..self.count].iter().sum()
    }

    /// Returns the tension in the joint after cylinder `k` \[N\]; `None` if there is no such joint.
    pub(super) fn tension(&self, k: usize) -> Option<f64> {
        self.tension[..self.count].get(k).copied()
    }

    /// Returns the force of the joint after cylinder `k` on the next cylinder \[N\]; `None` if there is no
    /// such joint.
    pub(super) fn force(&self, k: usize) -> Option<Vector3<f64>> {
        let [x, y] = &self.force;
        (k < self.count).then(|| Vector3::new(x[k], y[k], 0.0))
    }
}
