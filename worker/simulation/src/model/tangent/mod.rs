//! The iteration matrix `S = mu M - gamma D - K` with `K = dQ/dq`, `D = dQ/dv`, analytic.
//!
//! The integrator chooses `mu` and `gamma`; elements do not know them. Left out are the derivatives
//! of the cylinders' velocity terms and of their inertia by the angles: a cylinder's moment of
//! inertia is 1e-6 kg m2, so they change the speed of Newton's method by nothing measurable and
//! its answer not at all.
mod anchor;
mod contact;

use crate::element::bushing::LinkTangent;
use crate::linear::{BLOCK, Block, Bordered};
use crate::math::elementary::sin_cos;
use crate::model::links::Instant;
use crate::model::{Machine, Scratch, pose::Pose};
use anchor::Anchor;
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Derivatives of force, torque on I and torque on J by one generalised coordinate.
type Column = [V3; 3];

/// The same by the position and the angles of a cylinder.
struct CylinderColumns {
    position: [M3; 3],
    angles: [M3; 3],
}

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
        self.rigid_tangent(at, gamma, scratch, matrix);
        for chain in 0..2 {
            self.joint_tangent(chain, at, gamma, scratch, matrix);
            self.contact_tangent(chain, at, gamma, scratch, matrix);
        }
    }

    fn inertia_blocks(&self, q: &[f64], mu: f64, matrix: &mut Bordered) {
        let d = &self.description;
        let [along, across] = self.cylinder_inertia;
        for chain in 0..2 {
            let base = self.layout.base_block(chain);
            let block = matrix.diagonal_mut(base);
            let inertia = if chain == 0 {
                self.rod_inertia()
            } else {
                d.suspension_mass
            };
            block[(0, 0)] += mu * inertia;
            for k in 1..BLOCK {
                block[(k, k)] = 1.0;
            }
            for j in 1..=self.cylinders(chain) {
                let (s, _) = sin_cos(q[(base + j) * BLOCK + 4]);
                let block = matrix.diagonal_mut(base + j);
                for k in 0..3 {
                    block[(k, k)] += mu * self.cylinder_mass;
                }
                block[(3, 3)] += mu * along;
                block[(3, 5)] -= mu * along * s;
                block[(5, 3)] -= mu * along * s;
                block[(4, 4)] += mu * across;
                block[(5, 5)] += mu * (across + (along - across) * s * s);
            }
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
    fn rigid_tangent(
        &self,
        at: &Instant<'_>,
        gamma: f64,
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
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
        for chain in 0..2 {
            let base = self.layout.base_block(chain);
            let count = self.cylinders(chain);
            for (j, pose) in self.chain_poses(chain, &scratch.poses).iter().enumerate() {
                // the torques of both joints of this cylinder turn with its angles
                let torque = scratch.loads.joints[chain][j].torque_i
                    + scratch.loads.joints[chain][j + 1].torque_j;
                let turning = pose.torque_by_angles(&torque);
                let mut view = matrix
                    .diagonal_mut(base + 1 + j)
                    .fixed_view_mut::<3, 3>(3, 3);
                view -= turning;
                debug_assert!(j < count);
            }
        }
    }

    fn joint_tangent(
        &self,
        chain: usize,
        at: &Instant<'_>,
        gamma: f64,
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
        let base = self.layout.base_block(chain);
        let count = self.cylinders(chain);
        let poses = self.chain_poses(chain, &scratch.poses);
        for joint in 0..=count {
            let [i, j] = self.markers(chain, joint, &scratch.poses, at);
            let load = &scratch.loads.joints[chain][joint];
            let [by_i, by_j] = self.law(chain, joint, at.ropes).tangent(&i, &j, load);
            let block = base + joint;
            if joint == 0 {
                let columns = cylinder_columns(&by_i, &poses[0], gamma);
                let base_column = base_column(chain, &by_j, gamma);
                let row_j = |c: &Column| if chain == 0 { c[2].z } else { -c[0].y };
                matrix.diagonal_mut(block)[(0, 0)] -= row_j(&base_column);
                let angular = poses[0].angular();
                let (upper, lower) = matrix.coupling_mut(block);
                for k in 0..BLOCK {
                    upper[(0, k)] -= row_j(&columns.column(k));
                }
                subtract_column(lower, 0, &base_column[0], &angular.tr_mul(&base_column[1]));
                subtract_own(matrix.diagonal_mut(block + 1), &columns, &angular, Side::I);
            } else if joint < count {
                let columns_i = cylinder_columns(&by_i, &poses[joint], gamma);
                let columns_j = cylinder_columns(&by_j, &poses[joint - 1], gamma);
                let angular_i = poses[joint].angular();
                let angular_j = poses[joint - 1].angular();
                subtract_own(matrix.diagonal_mut(block), &columns_j, &angular_j, Side::J);
                let (upper, lower) = matrix.coupling_mut(block);
                subtract_own(upper, &columns_i, &angular_j, Side::J);
                subtract_own(lower, &columns_j, &angular_i, Side::I);
                subtract_own(
                    matrix.diagonal_mut(block + 1),
                    &columns_i,
                    &angular_i,
                    Side::I,
                );
            } else {
                let columns_j = cylinder_columns(&by_j, &poses[joint - 1], gamma);
                self.anchor_tangent(
                    &Anchor {
                        chain,
                        block,
                        by_head: &by_i,
                        by_cylinder: &columns_j,
                        force: load.force,
                        pose: &poses[joint - 1],
                    },
                    at,
                    gamma,
                    matrix,
                );
            }
        }
    }
}

/// Which body of a joint a block's rows belong to.
#[derive(Clone, Copy)]
enum Side {
    I,
    J,
}

impl CylinderColumns {
    fn column(&self, k: usize) -> Column {
        let of = if k < 3 { &self.position } else { &self.angles };
        std::array::from_fn(|row| of[row].column(k % 3).into_owned())
    }
}

fn cylinder_columns(by: &LinkTangent, pose: &Pose, gamma: f64) -> CylinderColumns {
    let angular = pose.angular();
    let spin = angular * gamma + pose.angular_rate();
    CylinderColumns {
        position: std::array::from_fn(|r| by.p[r] + by.v[r] * gamma),
        angles: std::array::from_fn(|r| by.a[r] * angular + by.w[r] * spin),
    }
}

/// Derivatives by the one coordinate of the rod (its angle) or the suspension (its height).
fn base_column(chain: usize, by: &LinkTangent, gamma: f64) -> Column {
    std::array::from_fn(|r| {
        if chain == 0 {
            (by.a[r] + by.w[r] * gamma).column(2).into_owned()
        } else {
            (by.p[r] + by.v[r] * gamma).column(1).into_owned()
        }
    })
}

/// Subtracts the rows of one side's cylinder: force and generalised torque.
fn subtract_own(block: &mut Block, columns: &CylinderColumns, angular: &M3, side: Side) {
    let (sign, torque) = match side {
        Side::I => (1.0, 1),
        Side::J => (-1.0, 2),
    };
    for (first, part) in [(0, &columns.position), (3, &columns.angles)] {
        let turned = angular.tr_mul(&part[torque]);
        for c in 0..3 {
            for r in 0..3 {
                block[(r, first + c)] -= sign * part[0][(r, c)];
                block[(3 + r, first + c)] -= turned[(r, c)];
            }
        }
    }
}

fn subtract_column(block: &mut Block, column: usize, force: &V3, torque: &V3) {
    for r in 0..3 {
        block[(r, column)] -= force[r];
        block[(3 + r, column)] -= torque[r];
    }
}
