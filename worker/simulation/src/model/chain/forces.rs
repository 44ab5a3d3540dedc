//! Forces on the cylinders of a chain, and of its contact on whoever carries the arc.
use super::{Chain, ChainState, Joints};
use crate::effect::Along;
use crate::element::bushing::Marker;
use crate::element::impact::Impact;
use crate::linear::BLOCK;
use crate::model::MAX_MODES;
use crate::model::contact::{Surface, Touch};
use crate::model::pose::Pose;
use nalgebra::{Vector2, Vector3};

type V2 = Vector2<f64>;
type V3 = Vector3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Fills the poses of all cylinders.
    pub(crate) fn pose(&self, q: &[f64], v: &[f64], poses: &mut [Pose]) {
        for (j, pose) in poses.iter_mut().enumerate() {
            let at = (self.first + j) * BLOCK..(self.first + j + 1) * BLOCK;
            *pose = Pose::new(&q[at.clone()], &v[at]);
        }
    }

    /// Adds the weight of the cylinders under `gravity` [m/s2] and their velocity terms.
    pub(crate) fn add_weights(&self, gravity: &V3, poses: &[Pose], force: &mut [f64]) {
        let [along, across] = self.inertia;
        let weight = gravity * self.mass;
        for (j, pose) in poses.iter().enumerate() {
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
        for joint in 0..=self.count {
            let Some(([i, j], law)) = self.link(joint, joints, &state.poses) else {
                continue;
            };
            let mut load = law.load(&i, &j);
            if let Some(along) = self.along(joint, joints, state, (&i, &j)) {
                let lost = along.other * law.extension(&i, &j)[1];
                law.add_pull((&i, &j), (along.spring + along.other, lost), &mut load);
            }
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
            let Some(([i, j], law)) = self.link(joint, joints, &state.poses) else {
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

    /// Adds the contact forces on the cylinders and on the `border`: the beam angle, then the
    /// modes. An arc that is fixed in W has no border.
    pub(crate) fn add_contact(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &mut ChainState,
        force: &mut [f64],
        border: &mut [f64],
    ) {
        state.deepest = 0.0;
        state.dissipated = 0.0;
        let half = 0.5 * self.pitch;
        let modes = surface.modal.len();
        let mut shape = [0.0; MAX_MODES];
        for (j, pose) in state.poses.iter().enumerate() {
            let mut total = 0.0;
            if let Some(bearing) = surface.bearing(&pose.p.xy(), half) {
                let (axis, sweep) = (pose.axis(), pose.axis_velocity());
                for &(place, share) in self.contact_points {
                    let along = place * half;
                    let g: V2 = (pose.p + axis * along).xy();
                    let velocity: V2 = (pose.v + sweep * along).xy();
                    let touch = surface.touch(&bearing, &g, &velocity, &mut shape[..modes]);
                    state.deepest = state.deepest.max(touch.depth);
                    let law = law.force(touch.depth, touch.rate);
                    state.dissipated += share * law.dissipated;
                    let f = share * law.force;
                    if f == 0.0 {
                        continue;
                    }
                    total += f;
                    let push = touch.by_point * -f;
                    let own = (self.first + j) * BLOCK;
                    force[own] += push.x;
                    force[own + 1] += push.y;
                    for k in 0..2 {
                        force[own + 4 + k] += along * push.dot(&pose.axis_by[k].xy());
                    }
                    if let Some((beam, modal)) = border.split_first_mut() {
                        *beam -= f * touch.by_beam;
                        for (modal, shape) in modal.iter_mut().zip(&shape[..modes]) {
                            *modal -= f * shape;
                        }
                    }
                }
            }
            state.contact[j] = total;
        }
    }

    /// Calls `visit(share, touch, shapes)` for every Gauss point inside the arc.
    pub(crate) fn each_touch(
        &self,
        surface: &Surface<'_>,
        poses: &[Pose],
        mut visit: impl FnMut(f64, &Touch, &[f64]),
    ) {
        let half = 0.5 * self.pitch;
        let modes = surface.modal.len();
        let mut shape = [0.0; MAX_MODES];
        for pose in poses {
            let Some(bearing) = surface.bearing(&pose.p.xy(), half) else {
                continue;
            };
            for &(place, share) in self.contact_points {
                let along = place * half;
                let g = (pose.p + pose.axis() * along).xy();
                let velocity = (pose.v + pose.axis_velocity() * along).xy();
                let touch = surface.touch(&bearing, &g, &velocity, &mut shape[..modes]);
                if touch.depth > 0.0 {
                    visit(share, &touch, &shape[..modes]);
                }
            }
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
