//! The iteration matrix `S = mu M - gamma D - K` with `K = dQ/dq`, `D = dQ/dv`, analytic.
//!
//! The integrator chooses `mu` and `gamma`; elements do not know them. Left out are the derivatives
//! of the cylinders' velocity terms and of their inertia by the angles: a cylinder's moment of
//! inertia is 1e-6 kg m2, so they change the speed of Newton's method by nothing measurable and
//! its answer not at all.
use crate::linear::{BLOCK, Block, Bordered};
use crate::math::elementary::sin_cos;
use crate::model::anchor::Anchor;
use crate::model::chain::{Column, EndTangent};
use crate::model::links::Instant;
use crate::model::{Machine, Scratch, pose::Pose};
use nalgebra::Vector3;

type V3 = Vector3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Fills `matrix` with `mu M - gamma D - K` at a state whose loads and poses are in `scratch`.
    pub fn tangent(
        &self,
        at: &Instant<'_>,
        (mu, gamma): (f64, f64),
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
        matrix.clear();
        self.inertia_blocks(at.q, mu, matrix);
        self.rigid_tangent(at, gamma, matrix);
        for (k, chain) in self.chains.iter().enumerate() {
            let state = &scratch.chains[k];
            let [base, head] = chain.add_joint_tangent(&self.joints(k, at), state, gamma, matrix);
            if let Some(base) = base {
                self.base_tangent(k, &base, &state.poses[0], gamma, matrix);
            }
            if let (Some(end), Some(load)) = (head, state.joints.last()) {
                let anchor = Anchor {
                    chain: k,
                    block: chain.first + chain.count - 1,
                    end: &end,
                    force: load.force,
                    pose: &state.poses[chain.count - 1],
                };
                self.anchor_tangent(&anchor, at, gamma, matrix);
            }
            let surface = self.surface(k, at.q, at.v);
            chain.add_contact_tangent(&surface, &at.ropes.contact, state, gamma, matrix);
        }
        self.hooks.add_tangent(at, gamma, matrix);
    }

    fn inertia_blocks(&self, q: &[f64], mu: f64, matrix: &mut Bordered) {
        let d = &self.description;
        for (k, chain) in self.chains.iter().enumerate() {
            let block = matrix.diagonal_mut(self.layout.base_block(k));
            let inertia = if k == 0 {
                self.rod_inertia()
            } else {
                d.suspension_mass
            };
            block[(0, 0)] += mu * inertia;
            for k in 1..BLOCK {
                block[(k, k)] = 1.0;
            }
            chain.add_inertia_blocks(q, mu, matrix);
        }
        matrix.add_corner(0, 0, mu * d.beam_inertia);
        for k in 0..self.layout.modes {
            let coupling = mu * d.head.participation[k][2];
            matrix.add_corner(1 + k, 1 + k, mu);
            matrix.add_corner(0, 1 + k, coupling);
            matrix.add_corner(1 + k, 0, coupling);
        }
    }

    /// Weights, the head's own stiffness and damping.
    fn rigid_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered) {
        let &Instant { q, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let (s, c) = sin_cos(q[self.layout.rod()]);
        let pin = drive.pin[2];
        matrix.diagonal_mut(0)[(0, 0)] -=
            d.rod.mass * d.rod.center_of_mass * ((pin.y + g) * s + pin.x * c);
        let (s, c) = sin_cos(q[self.layout.beam()]);
        matrix.add_corner(0, 0, -d.beam_gravity_moment * s);
        for k in 0..self.layout.modes {
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            let x = q[self.layout.mode(k)];
            matrix.add_corner(1 + k, 1 + k, w * w + gamma * 2.0 * d.head.damping_ratio * w);
            let turning = g * (px * c - py * s);
            matrix.add_corner(1 + k, 0, turning);
            matrix.add_corner(0, 1 + k, turning);
            matrix.add_corner(0, 0, -x * g * (py * c + px * s));
        }
    }

    /// The joint between rod (0) or suspension (1) and the first cylinder.
    fn base_tangent(
        &self,
        chain: usize,
        end: &EndTangent,
        pose: &Pose,
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        let block = self.layout.base_block(chain);
        let column = base_column(chain, &end.by_body, gamma);
        let row_j = |c: &Column| if chain == 0 { c[2].z } else { -c[0].y };
        matrix.diagonal_mut(block)[(0, 0)] -= row_j(&column);
        let (upper, lower) = matrix.coupling_mut(block);
        for k in 0..BLOCK {
            upper[(0, k)] -= row_j(&end.by_cylinder.column(k));
        }
        let torque = pose.angular().tr_mul(&column[1]);
        subtract_column(lower, 0, &column[0], &torque);
    }
}

/// Derivatives by the one coordinate of the rod (its angle) or the suspension (its height).
fn base_column(chain: usize, by: &crate::element::bushing::LinkTangent, gamma: f64) -> Column {
    std::array::from_fn(|r| {
        if chain == 0 {
            (by.a[r] + by.w[r] * gamma).column(2).into_owned()
        } else {
            (by.p[r] + by.v[r] * gamma).column(1).into_owned()
        }
    })
}

fn subtract_column(block: &mut Block, column: usize, force: &V3, torque: &V3) {
    for r in 0..3 {
        block[(r, column)] -= force[r];
        block[(3 + r, column)] -= torque[r];
    }
}
