//! Forces of gravity and joints on the cylinders of a chain.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use crate::element::bushing::LinkLoad;
use crate::linear::BLOCK;
use crate::model::layout::Motion;
use crate::model::pose::Pose;
use nalgebra::Vector3;

type V3 = Vector3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Computes the poses of all cylinders from coordinates `q` and rates `v` into `state`.
    pub(crate) fn pose(&self, q: &[f64], v: &[f64], state: &mut ChainState) {
        let width = self.motion.width();
        let (q, v) = (&q[self.range()], &v[self.range()]);
        let cylinders = || q.chunks_exact(width).zip(v.chunks_exact(width));
        for (pose, (q, v)) in state.poses.iter_mut().zip(cylinders()) {
            *pose = Pose::new(q, v);
        }
        if !state.plane.is_empty() {
            state.plane.fill(q, v);
        }
    }

    /// Adds the weight of the cylinders under `gravity` [m/s2] and their velocity-dependent inertia terms to
    /// the generalised forces.
    pub(crate) fn add_weights(&self, gravity: &V3, state: &ChainState, force: &mut [f64]) {
        let [along, across] = self.inertia;
        let weight = gravity * self.mass;
        if self.motion == Motion::Plane {
            for force in force[self.range()].chunks_exact_mut(3) {
                force[0] += weight.x;
                force[1] += weight.y;
            }
            return;
        }
        for (j, pose) in state.poses.iter().enumerate() {
            let at = (self.first + j) * BLOCK;
            for k in 0..3 {
                force[at + k] += weight[k];
            }
            let [s, c] = pose.tilt;
            let (r1, r2, r3) = (pose.rate.x, pose.rate.y, pose.rate.z);
            let spin = along * (r1 - s * r3);
            force[at + 3] += along * c * r2 * r3;
            force[at + 4] -= c * r3 * spin + across * c * s * r3 * r3;
            force[at + 5] +=
                c * r2 * spin - along * s * c * r2 * r3 + 2.0 * across * c * s * r2 * r3;
        }
    }

    /// Computes only the load of the joint that fixes the chain to the head, and stores it in `state`.
    pub(crate) fn load_head(&self, joints: &Joints<'_>, state: &mut ChainState) {
        if let Some(([i, j], law)) = self.link(self.count, joints, state) {
            state.joints[self.count] = law.load(&i, &j);
        }
    }

    /// Adds the forces of all joints on the cylinders to the generalised forces; stores the joints' loads in
    /// `state`.
    pub(crate) fn add_joints(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        if self.motion == Motion::Plane {
            self.add_plane_joints(joints, state, force);
            return;
        }
        for joint in 0..=self.count {
            self.add_space_joint(joint, joints, state, force);
        }
    }

    /// Adds the forces of the two end joints on the cylinders to the generalised forces; stores the joints'
    /// loads in `state`.
    pub(crate) fn add_ends(&self, joints: &Joints<'_>, state: &mut ChainState, force: &mut [f64]) {
        if self.motion == Motion::Plane {
            self.add_plane_ends(joints, state, force);
            return;
        }
        for joint in [0, self.count] {
            self.add_space_joint(joint, joints, state, force);
        }
    }

    fn add_space_joint(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        let Some(([i, j], law)) = self.link(joint, joints, state) else {
            return;
        };
        let mut load = law.load(&i, &j);
        if let Some(pull) = self.pull(joint, joints, state) {
            law.add_pull((&i, &j), &pull, &mut load);
        }
        self.add_load(joint, &load, state, force);
        state.joints[joint] = load;
    }

    /// Adds a joint's load to the generalised forces of the one or two cylinders that it connects, in space.
    pub(super) fn add_load(
        &self,
        joint: usize,
        load: &LinkLoad,
        state: &ChainState,
        force: &mut [f64],
    ) {
        let at = (self.first + joint) * BLOCK;
        if joint > 0 {
            add_wrench(
                &state.poses[joint - 1],
                &-load.force,
                &load.torque_j,
                &mut force[at - BLOCK..],
            );
        }
        if joint < self.count {
            add_wrench(
                &state.poses[joint],
                &load.force,
                &load.torque_i,
                &mut force[at..],
            );
        }
    }
}

fn add_wrench(pose: &Pose, force: &V3, torque: &V3, at: &mut [f64]) {
    for k in 0..3 {
        at[k] += force[k];
    }
    let turning = pose.angular().tr_mul(torque);
    for k in 0..3 {
        at[3 + k] += turning[k];
    }
}
