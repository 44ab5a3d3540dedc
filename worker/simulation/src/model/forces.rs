//! Generalised forces, inertia, and the powers that the energy ledger adds up.
//!
//! The equations of motion are `M(q) a = Q(q, v, t)`; this file gives `Q` and `M a`.
use crate::linear::BLOCK;
use crate::math::elementary::sin_cos;
use crate::model::contact::{GAUSS, Surface, Touch};
use crate::model::links::Instant;
use crate::model::{Machine, Scratch, pose::Pose};
use nalgebra::{Vector2, Vector3};

type V2 = Vector2<f64>;
type V3 = Vector3<f64>;

/// Powers and energies at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Powers {
    /// Of the crank pin on the rod \[W\].
    pub input: f64,
    /// Of the suspension point on the load \[W\].
    pub output: f64,
    /// Lost in joints, contact and head \[W\].
    pub dissipated: f64,
}

impl Machine {
    /// Fills the poses of all cylinders.
    pub(crate) fn pose(&self, q: &[f64], v: &[f64], poses: &mut [Pose]) {
        for chain in 0..2 {
            let first = self.layout.base_block(chain) + 1;
            let offset = if chain == 0 { 0 } else { self.layout.back };
            for j in 0..self.cylinders(chain) {
                let at = (first + j) * BLOCK..(first + j + 1) * BLOCK;
                poses[offset + j] = Pose::new(&q[at.clone()], &v[at]);
            }
        }
    }

    /// Generalised forces `Q(q, v, t)` into `force`; joint and contact loads stay in `scratch`.
    pub fn forces(&self, at: &Instant<'_>, scratch: &mut Scratch, force: &mut [f64]) {
        force.fill(0.0);
        self.pose(at.q, at.v, &mut scratch.poses);
        scratch.loads.deepest = 0.0;
        self.weights(at, &scratch.poses, force);
        for chain in 0..2 {
            self.joint_forces(chain, at, scratch, force);
            self.contact_forces(chain, at, scratch, force);
        }
    }

    /// Gravity, load, velocity terms, and the head's own stiffness and damping.
    fn weights(&self, at: &Instant<'_>, poses: &[Pose], force: &mut [f64]) {
        let &Instant { q, v, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let rod = self.layout.rod();
        let (s, c) = sin_cos(q[rod]);
        let pin = drive.pin[2];
        // the pin's acceleration acts on the rod like a field
        force[rod] = -d.rod.mass * d.rod.center_of_mass * ((pin.y + g) * c - pin.x * s);
        force[self.layout.suspension()] = -d.suspension_mass * g - drive.load;

        let beam = self.layout.beam();
        let (s, c) = sin_cos(q[beam]);
        force[beam] = -d.beam_gravity_moment * c;
        for k in 0..self.layout.modes {
            let i = self.layout.mode(k);
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            force[i] =
                -g * (px * s + py * c) - w * w * q[i] - 2.0 * d.head.damping_ratio * w * v[i];
            force[beam] += q[i] * g * (py * s - px * c);
        }

        let [along, across] = self.cylinder_inertia;
        for chain in 0..2 {
            let first = self.layout.base_block(chain) + 1;
            for (j, pose) in self.chain_poses(chain, poses).iter().enumerate() {
                let at = (first + j) * BLOCK;
                force[at + 1] -= self.cylinder_mass * g;
                let [s, c] = pose.tilt;
                let (r1, r2, r3) = (pose.rate.x, pose.rate.y, pose.rate.z);
                let spin = along * (r1 - s * r3);
                force[at + 3] += along * c * r2 * r3;
                force[at + 4] -= c * r3 * spin + across * c * s * r3 * r3;
                force[at + 5] +=
                    c * r2 * spin - along * s * c * r2 * r3 + 2.0 * across * c * s * r2 * r3;
            }
        }
    }

    fn joint_forces(
        &self,
        chain: usize,
        at: &Instant<'_>,
        scratch: &mut Scratch,
        force: &mut [f64],
    ) {
        let base = self.layout.base_block(chain);
        let count = self.cylinders(chain);
        for joint in 0..=count {
            let [i, j] = self.markers(chain, joint, &scratch.poses, at);
            let load = self.law(chain, joint, at.ropes).load(&i, &j);
            if joint > 0 {
                let pose = &self.chain_poses(chain, &scratch.poses)[joint - 1];
                add_wrench(
                    pose,
                    &-load.force,
                    &load.torque_j,
                    &mut force[(base + joint) * BLOCK..],
                );
            } else if chain == 0 {
                force[self.layout.rod()] += load.torque_j.z;
            } else {
                force[self.layout.suspension()] -= load.force.y;
            }
            if joint < count {
                let pose = &self.chain_poses(chain, &scratch.poses)[joint];
                add_wrench(
                    pose,
                    &load.force,
                    &load.torque_i,
                    &mut force[(base + joint + 1) * BLOCK..],
                );
            } else {
                let beam = self.layout.beam();
                force[beam] += load.torque_i.z + i.p.x * load.force.y - i.p.y * load.force.x;
                if chain == 0 {
                    let (s, c) = sin_cos(at.q[beam]);
                    for (k, shape) in self.anchor_shape.iter().enumerate() {
                        force[self.layout.mode(k)] += load.force.x * (c * shape[0] - s * shape[1])
                            + load.force.y * (s * shape[0] + c * shape[1]);
                    }
                }
            }
            scratch.loads.joints[chain][joint] = load;
        }
    }

    /// The arc of a chain at an instant.
    pub(crate) fn surface<'a>(&'a self, chain: usize, q: &'a [f64], v: &'a [f64]) -> Surface<'a> {
        let beam = self.layout.beam();
        let modal = if chain == 0 { beam + 1..q.len() } else { 0..0 };
        Surface::new(
            self.arc(chain),
            [q[beam], v[beam]],
            (&q[modal.clone()], &v[modal]),
            (chain == 0).then_some(&self.radial),
        )
    }

    fn contact_forces(
        &self,
        chain: usize,
        at: &Instant<'_>,
        scratch: &mut Scratch,
        force: &mut [f64],
    ) {
        let surface = self.surface(chain, at.q, at.v);
        let half = 0.5 * self.description.rope.pitch;
        let first = self.layout.base_block(chain) + 1;
        let beam = self.layout.beam();
        let modes = surface.modal.len();
        let mut shape = [0.0; MAX_MODES];
        for j in 0..self.cylinders(chain) {
            let pose = &self.chain_poses(chain, &scratch.poses)[j];
            let mut total = 0.0;
            if let Some(bearing) = surface.bearing(&pose.p.xy(), half) {
                let (axis, sweep) = (pose.axis(), pose.axis_velocity());
                for (place, share) in GAUSS {
                    let along = place * half;
                    let g: V2 = (pose.p + axis * along).xy();
                    let velocity: V2 = (pose.v + sweep * along).xy();
                    let touch = surface.touch(&bearing, &g, &velocity, &mut shape[..modes]);
                    scratch.loads.deepest = scratch.loads.deepest.max(touch.depth);
                    let law = at.ropes.contact.force(touch.depth, touch.rate);
                    let f = share * law.force;
                    if f == 0.0 {
                        continue;
                    }
                    total += f;
                    let push = touch.by_point * -f;
                    let own = (first + j) * BLOCK;
                    force[own] += push.x;
                    force[own + 1] += push.y;
                    for k in 0..2 {
                        force[own + 4 + k] += along * push.dot(&pose.axis_by[k].xy());
                    }
                    force[beam] -= f * touch.by_beam;
                    for k in 0..modes {
                        force[beam + 1 + k] -= f * shape[k];
                    }
                }
            }
            scratch.loads.contact[chain][j] = total;
        }
    }

    /// `out -= M(q) a`.
    pub fn subtract_inertia(&self, q: &[f64], a: &[f64], out: &mut [f64]) {
        let d = &self.description;
        let rod = self.layout.rod();
        out[rod] -= self.rod_inertia() * a[rod];
        let at = self.layout.suspension();
        out[at] -= d.suspension_mass * a[at];
        let beam = self.layout.beam();
        out[beam] -= d.beam_inertia * a[beam];
        for k in 0..self.layout.modes {
            let i = self.layout.mode(k);
            let coupling = d.head.participation[k][2];
            out[i] -= a[i] + coupling * a[beam];
            out[beam] -= coupling * a[i];
        }
        let [along, across] = self.cylinder_inertia;
        let m = self.cylinder_mass;
        for chain in 0..2 {
            let first = self.layout.base_block(chain) + 1;
            for j in 0..self.cylinders(chain) {
                let at = (first + j) * BLOCK;
                let (s, _) = sin_cos(q[at + 4]);
                for k in 0..3 {
                    out[at + k] -= m * a[at + k];
                }
                let (a1, a2, a3) = (a[at + 3], a[at + 4], a[at + 5]);
                out[at + 3] -= along * (a1 - s * a3);
                out[at + 4] -= across * a2;
                out[at + 5] -= (across + (along - across) * s * s) * a3 - along * s * a1;
            }
        }
    }

    /// Moment of inertia of the rod about the crank pin [kg m2].
    pub(crate) fn rod_inertia(&self) -> f64 {
        let rod = &self.description.rod;
        rod.inertia + rod.mass * rod.center_of_mass * rod.center_of_mass
    }

    /// Force that the crank pin exerts on the rod, given joint loads and accelerations \[N\].
    pub fn pin_force(&self, at: &Instant<'_>, a: &[f64], scratch: &Scratch) -> V2 {
        let rod = &self.description.rod;
        let i = self.layout.rod();
        let (s, c) = sin_cos(at.q[i]);
        let center = at.drive.pin[2] + V2::new(-s, c) * (rod.center_of_mass * a[i])
            - V2::new(c, s) * (rod.center_of_mass * at.v[i] * at.v[i]);
        // the joint pulls the rod with minus the force on the first cylinder
        let rope = scratch.loads.joints[0][0].force;
        V2::new(
            rod.mass * center.x + rope.x,
            rod.mass * (center.y + self.description.gravity) + rope.y,
        )
    }

    /// Powers at an instant whose loads are in `scratch`.
    pub fn powers(&self, at: &Instant<'_>, a: &[f64], scratch: &Scratch) -> Powers {
        let v = at.v;
        let pin = self.pin_force(at, a, scratch);
        let mut dissipated: f64 = scratch
            .loads
            .joints
            .iter()
            .flat_map(|chain| chain.iter().map(|load| load.dissipated))
            .sum();
        for chain in 0..2 {
            self.each_touch(chain, at, &scratch.poses, |share, touch, _| {
                dissipated += share * at.ropes.contact.force(touch.depth, touch.rate).dissipated;
            });
        }
        let head = &self.description.head;
        for k in 0..self.layout.modes {
            let rate = v[self.layout.mode(k)];
            dissipated += 2.0 * head.damping_ratio * head.frequencies[k] * rate * rate;
        }
        Powers {
            input: pin.dot(&at.drive.pin[1]),
            output: at.drive.load * v[self.layout.suspension()],
            dissipated,
        }
    }

    /// Calls `visit(share, touch, shapes)` for every Gauss point inside an arc.
    pub(crate) fn each_touch(
        &self,
        chain: usize,
        at: &Instant<'_>,
        poses: &[Pose],
        mut visit: impl FnMut(f64, &Touch, &[f64]),
    ) {
        let surface = self.surface(chain, at.q, at.v);
        let half = 0.5 * self.description.rope.pitch;
        let modes = surface.modal.len();
        let mut shape = [0.0; MAX_MODES];
        for pose in self.chain_poses(chain, poses) {
            let Some(bearing) = surface.bearing(&pose.p.xy(), half) else {
                continue;
            };
            for (place, share) in GAUSS {
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

    /// Kinetic plus potential energy without the load's \[J\]; `scratch` holds the poses.
    pub fn energy(&self, at: &Instant<'_>, scratch: &Scratch) -> f64 {
        self.potential(at, scratch) + self.kinetic(at)
    }

    /// Elastic and gravitational energy \[J\].
    pub fn potential(&self, at: &Instant<'_>, scratch: &Scratch) -> f64 {
        let &Instant { q, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let (rod, beam) = (self.layout.rod(), self.layout.beam());
        let mut sum = d.rod.mass * g * (drive.pin[0].y + d.rod.center_of_mass * sin_cos(q[rod]).0)
            + d.suspension_mass * g * q[self.layout.suspension()];
        let (s, c) = sin_cos(q[beam]);
        sum += d.beam_gravity_moment * s;
        for k in 0..self.layout.modes {
            let x = q[self.layout.mode(k)];
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            sum += 0.5 * w * w * x * x + g * x * (px * s + py * c);
        }
        for chain in 0..2 {
            for joint in 0..=self.cylinders(chain) {
                let [i, j] = self.markers(chain, joint, &scratch.poses, at);
                sum += self.law(chain, joint, at.ropes).energy(&i, &j);
            }
            self.each_touch(chain, at, &scratch.poses, |share, touch, _| {
                sum += share * at.ropes.contact.energy(touch.depth);
            });
            for pose in self.chain_poses(chain, &scratch.poses) {
                sum += self.cylinder_mass * g * pose.p.y;
            }
        }
        sum
    }

    fn kinetic(&self, at: &Instant<'_>) -> f64 {
        let &Instant { q, v, drive, .. } = at;
        // M v through the inertia operator; the rod's part relative to the moving pin is added
        let mut momentum = vec![0.0; v.len()];
        self.subtract_inertia(q, v, &mut momentum);
        let own: f64 = momentum.iter().zip(v).map(|(p, v)| -0.5 * p * v).sum();
        let rod = &self.description.rod;
        let i = self.layout.rod();
        let (s, c) = sin_cos(q[i]);
        let pin = drive.pin[1];
        own + 0.5 * rod.mass * pin.norm_squared()
            + rod.mass * rod.center_of_mass * v[i] * (pin.y * c - pin.x * s)
    }
}

/// Most modes a head may have in a simulation.
pub(crate) const MAX_MODES: usize = 24;

fn add_wrench(pose: &Pose, force: &V3, torque: &V3, at: &mut [f64]) {
    for k in 0..3 {
        at[k] += force[k];
    }
    let turning = pose.angular().tr_mul(torque);
    for k in 0..3 {
        at[3 + k] += turning[k];
    }
}
