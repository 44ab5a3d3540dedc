//! Forces of weight and joints on the cylinders of a chain.
use super::{Chain, ChainState, Joints};
use crate::effect::Along;
use crate::element::bushing::Marker;
use crate::linear::BLOCK;
use crate::model::layout::Motion;
use crate::model::pose::{PlanePose, Pose};
use nalgebra::Vector3;

type V3 = Vector3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Fills the poses of all cylinders.
    pub(crate) fn pose(&self, q: &[f64], v: &[f64], state: &mut ChainState) {
        let width = self.motion.width();
        let (q, v) = (&q[self.range()], &v[self.range()]);
        let cylinders = || q.chunks_exact(width).zip(v.chunks_exact(width));
        for (pose, (q, v)) in state.poses.iter_mut().zip(cylinders()) {
            *pose = Pose::new(q, v);
        }
        for (pose, (q, v)) in state.plane.iter_mut().zip(cylinders()) {
            *pose = PlanePose::new(q, v);
        }
    }

    /// Adds the weight of the cylinders under `gravity` [m/s2] and their velocity terms.
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

    /// Adds the joints' forces on the cylinders; the loads stay in `state`.
    pub(crate) fn add_joints(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        self.add_plane_joints(joints, state, force);
        for joint in 0..=self.count {
            if self.in_plane(joint, joints) {
                continue;
            }
            let Some(([i, j], law)) = self.link(joint, joints, state) else {
                continue;
            };
            let mut load = law.load(&i, &j);
            if let Some(along) = self.along(joint, joints, state, (&i, &j)) {
                let lost = along.other * law.extension(&i, &j)[1];
                law.add_pull((&i, &j), (along.spring + along.other, lost), &mut load);
            }
            if joint > 0 {
                self.add_wrench(joint - 1, state, [&-load.force, &load.torque_j], force);
            }
            if joint < self.count {
                self.add_wrench(joint, state, [&load.force, &load.torque_i], force);
            }
            state.joints[joint] = load;
        }
    }

    /// What laws along the rope pull in a joint between two cylinders, markers I and J.
    pub(super) fn along(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
        (i, j): (&Marker, &Marker),
    ) -> Option<Along> {
        let laws = joints.axial.filter(|_| joint > 0 && joint < self.count)?;
        let [extension, rate] = joints.inner.extension(i, j);
        Some(laws.pull(extension, rate, state.memory.get(joint).copied()))
    }

    /// Lets laws with a past remember the step that ended in these poses.
    pub(crate) fn remember(&self, joints: &Joints<'_>, state: &mut ChainState) {
        let Some(laws) = joints.axial else { return };
        let first = state.memory.is_empty();
        state.memory.resize(self.count + 1, [0.0; 2]);
        for joint in 1..self.count {
            let Some(([i, j], law)) = self.link(joint, joints, state) else {
                continue;
            };
            let [extension, rate] = law.extension(&i, &j);
            let before = (!first).then(|| state.memory[joint]);
            let Some(memory) = laws.remember(extension, rate, before) else {
                state.memory.clear();
                return;
            };
            state.memory[joint] = memory;
        }
    }

    /// Adds a force on cylinder `j` and a torque about its centre.
    fn add_wrench(&self, j: usize, state: &ChainState, on: [&V3; 2], force: &mut [f64]) {
        let [push, torque] = on;
        let at = (self.first + j) * self.motion.width();
        match self.motion {
            Motion::Plane => {
                force[at] += push.x;
                force[at + 1] += push.y;
                force[at + 2] += torque.z;
            }
            Motion::Space => {
                let turning = state.poses[j].angular().tr_mul(torque);
                for k in 0..3 {
                    force[at + k] += push[k];
                    force[at + 3 + k] += turning[k];
                }
            }
        }
    }
}
