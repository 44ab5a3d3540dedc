//! The iteration matrix `S = mu M - gamma D - K` with `K = dQ/dq`, `D = dQ/dv`, analytic.
//!
//! The integrator chooses `mu` and `gamma`; elements do not know them. Left out are the derivatives
//! of the cylinders' velocity terms and of their inertia by the angles: a cylinder's moment of
//! inertia is 1e-6 kg m2, so they change the speed of Newton's method by nothing measurable and
//! its answer not at all.
use crate::drive::DriveState;
use crate::element::bushing::LinkTangent;
use crate::linear::{BLOCK, Block, Bordered};
use crate::math::elementary::sin_cos;
use crate::model::contact::{Curvature, GAUSS, Touch};
use crate::model::forces::MAX_MODES;
use crate::model::links::MarkerState;
use crate::model::{Machine, Ropes, Scratch, pose::Pose};
use nalgebra::{Matrix3, Vector2, Vector3};

type V2 = Vector2<f64>;
type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Derivatives of force, torque on I and torque on J by one generalised coordinate.
type Column = [V3; 3];

/// The same by the position and the angles of a cylinder.
struct CylinderColumns {
    position: [M3; 3],
    angles: [M3; 3],
}

impl Machine {
    /// Fills `matrix` with `mu M - gamma D - K` at a state whose loads and poses are in `scratch`.
    pub fn tangent(
        &self,
        ropes: &Ropes,
        drive: &DriveState,
        (q, v): (&[f64], &[f64]),
        (mu, gamma): (f64, f64),
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
        matrix.clear();
        self.inertia_blocks(q, mu, matrix);
        self.rigid_tangent(drive, (q, v), gamma, scratch, matrix);
        let state = MarkerState { q, v, drive };
        for chain in 0..2 {
            self.joint_tangent(chain, ropes, &state, gamma, scratch, matrix);
            self.contact_tangent(chain, ropes, &state, gamma, scratch, matrix);
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
        drive: &DriveState,
        (q, _): (&[f64], &[f64]),
        gamma: f64,
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
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
        ropes: &Ropes,
        state: &MarkerState<'_>,
        gamma: f64,
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
        let base = self.layout.base_block(chain);
        let count = self.cylinders(chain);
        let poses = self.chain_poses(chain, &scratch.poses);
        for joint in 0..=count {
            let [i, j] = self.markers(chain, joint, &scratch.poses, state);
            let load = &scratch.loads.joints[chain][joint];
            let [by_i, by_j] = self.law(chain, joint, ropes).tangent(&i, &j, load);
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
                    chain,
                    block,
                    state,
                    gamma,
                    (&by_i, &columns_j),
                    load.force,
                    &poses[joint - 1],
                    matrix,
                );
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "one call, all of it needed")]
    fn anchor_tangent(
        &self,
        chain: usize,
        block: usize,
        state: &MarkerState<'_>,
        gamma: f64,
        (by_i, columns_j): (&LinkTangent, &CylinderColumns),
        F: V3,
        pose: &Pose,
        matrix: &mut Bordered,
    ) {
        let beam = self.layout.beam();
        let (s, c) = sin_cos(state.q[beam]);
        let rate = state.v[beam];
        let z = V3::z();
        // deflection of the anchor in W, its modes and its rate
        let mut shapes = [V3::zeros(); MAX_MODES];
        let modes = if chain == 0 { self.layout.modes } else { 0 };
        let (mut p, mut deflection_rate) = (V3::zeros(), V3::zeros());
        for k in 0..modes {
            let [x, y] = self.anchor_shape[k];
            shapes[k] = V3::new(c * x - s * y, s * x + c * y, 0.0);
            p += shapes[k] * state.q[self.layout.mode(k)];
            deflection_rate += shapes[k] * state.v[self.layout.mode(k)];
        }
        let zp = z.cross(&p);
        // velocity of the reference point: deflection_rate + rate z x p
        let by_angle: Column = std::array::from_fn(|r| {
            by_i.p[r] * zp
                + by_i.v[r] * (z.cross(&deflection_rate) + zp * gamma + z.cross(&zp) * rate)
                + by_i.a[r] * z
                + by_i.w[r] * z * gamma
        });
        let by_mode = |k: usize| -> Column {
            std::array::from_fn(|r| {
                by_i.p[r] * shapes[k] + by_i.v[r] * (shapes[k] * gamma + z.cross(&shapes[k]) * rate)
            })
        };
        let beam_row = |c: &Column| c[1].z + p.x * c[0].y - p.y * c[0].x;
        let angular = pose.angular();

        for k in 0..=modes {
            let column = if k == 0 { by_angle } else { by_mode(k - 1) };
            let turned = angular.tr_mul(&column[2]);
            for row in 0..3 {
                matrix.add_right(block, row, k, column[0][row]);
                matrix.add_right(block, 3 + row, k, -turned[row]);
            }
            let mut beam_entry = beam_row(&column);
            let moved = if k == 0 { zp } else { shapes[k - 1] };
            beam_entry += moved.x * F.y - moved.y * F.x;
            matrix.add_corner(0, k, -beam_entry);
            for (row, shape) in shapes[..modes].iter().enumerate() {
                let mut entry = column[0].dot(shape);
                if k == 0 {
                    entry += F.dot(&z.cross(shape));
                }
                matrix.add_corner(1 + row, k, -entry);
            }
        }
        for k in 0..BLOCK {
            let column = columns_j.column(k);
            matrix.add_bottom(block, 0, k, -beam_row(&column));
            for (row, shape) in shapes[..modes].iter().enumerate() {
                matrix.add_bottom(block, 1 + row, k, -column[0].dot(shape));
            }
        }
        subtract_own(matrix.diagonal_mut(block), columns_j, &angular, Side::J);
    }

    fn contact_tangent(
        &self,
        chain: usize,
        ropes: &Ropes,
        state: &MarkerState<'_>,
        gamma: f64,
        scratch: &Scratch,
        matrix: &mut Bordered,
    ) {
        let surface = self.surface(chain, state.q, state.v);
        let half = 0.5 * self.description.rope.pitch;
        let first = self.layout.base_block(chain) + 1;
        let modes = surface.modal.len();
        let beam_rate = state.v[self.layout.beam()];
        let mut shape = [0.0; MAX_MODES];
        for (j, pose) in self.chain_poses(chain, &scratch.poses).iter().enumerate() {
            let Some(bearing) = surface.bearing(&pose.p.xy(), half) else {
                continue;
            };
            for (place, share) in GAUSS {
                let along = place * half;
                let g: V2 = (pose.p + pose.axis() * along).xy();
                let velocity: V2 = (pose.v + pose.axis_velocity() * along).xy();
                let touch = surface.touch(&bearing, &g, &velocity, &mut shape[..modes]);
                let law = ropes.contact.force(touch.depth, touch.rate);
                if law.force == 0.0 {
                    continue;
                }
                let f = share * law.force;
                let by_rate = share * law.by_rate;
                let stiff = share * law.by_penetration + gamma * by_rate;
                let curvature = surface.curvature(&touch);
                let mut slopes = [0.0; MAX_MODES];
                if let Some(shapes) = surface.shapes {
                    let at = shapes.place(touch.angle);
                    for (k, slope) in slopes[..modes].iter_mut().enumerate() {
                        *slope = shapes.jet(&at, k).first;
                    }
                }
                let (angle_by_point, angle_by_beam) = curvature.angle_by;
                let drift = surface
                    .modal_rate
                    .iter()
                    .zip(&slopes)
                    .map(|(rate, slope)| rate * slope)
                    .sum::<f64>();
                // rate of the gradient along the motion: H z'
                let gradient_rate_point = curvature.point * velocity
                    + curvature.mixed * beam_rate
                    + angle_by_point * drift;
                let gradient_rate_beam = curvature.mixed.dot(&velocity)
                    + curvature.beam * beam_rate
                    + angle_by_beam * drift;
                let angle_rate = angle_by_point.dot(&velocity) + angle_by_beam * beam_rate;
                // derivative of the force by point, beam angle and modes
                let by_point = touch.by_point * stiff + gradient_rate_point * by_rate;
                let by_beam = touch.by_beam * stiff + gradient_rate_beam * by_rate;
                let point = PointTangent {
                    touch: &touch,
                    curvature: &curvature,
                    force: f,
                    by_rate,
                    by_point,
                    by_beam,
                };
                add_cylinder(matrix.diagonal_mut(first + j), pose, along, &point);
                let arms = [pose.axis_by[0].xy() * along, pose.axis_by[1].xy() * along];
                for k in 0..=modes {
                    // column of the border: beam angle or mode
                    let (by_column, mixed, gradient) = if k == 0 {
                        (by_beam, curvature.mixed, touch.by_beam)
                    } else {
                        let slope = slopes[k - 1];
                        (
                            shape[k - 1] * stiff + slope * angle_rate * by_rate,
                            angle_by_point * slope,
                            shape[k - 1],
                        )
                    };
                    let column = touch.by_point * by_column + mixed * f;
                    let row = by_point * gradient + mixed * f;
                    add_border(matrix, first + j, k, (&column, &row), &arms);
                    for (a, arm_rate) in pose.axis_velocity_by().iter().enumerate() {
                        // the point's velocity turns with the cylinder's angles
                        let turning = by_rate * along * touch.by_point.dot(&arm_rate.xy());
                        matrix.add_bottom(first + j, k, 4 + a, gradient * turning);
                    }
                    for m in 0..=modes {
                        let (other, other_by) = if m == 0 {
                            (touch.by_beam, by_beam)
                        } else {
                            (
                                shape[m - 1],
                                shape[m - 1] * stiff + slopes[m - 1] * angle_rate * by_rate,
                            )
                        };
                        let bend = match (k, m) {
                            (0, 0) => curvature.beam,
                            (0, _) => angle_by_beam * slopes[m - 1],
                            (_, 0) => angle_by_beam * slopes[k - 1],
                            _ => 0.0,
                        };
                        matrix.add_corner(k, m, gradient * other_by + bend * f);
                        debug_assert!(other.is_finite());
                    }
                }
            }
        }
    }
}

/// What one Gauss point adds to its cylinder's own block.
struct PointTangent<'a> {
    touch: &'a Touch,
    curvature: &'a Curvature,
    force: f64,
    by_rate: f64,
    by_point: V2,
    by_beam: f64,
}

fn add_cylinder(block: &mut Block, pose: &Pose, along: f64, point: &PointTangent<'_>) {
    let touch = point.touch;
    debug_assert!(point.by_beam.is_finite());
    let core = touch.by_point * point.by_point.transpose() + point.curvature.point * point.force;
    let arms = [pose.axis_by[0].xy() * along, pose.axis_by[1].xy() * along];
    let bends = pose.axis_by_twice();
    let sweeps = pose.axis_velocity_by();
    for r in 0..2 {
        for c in 0..2 {
            block[(r, c)] += core[(r, c)];
        }
    }
    for (a, arm) in arms.iter().enumerate() {
        let turning = point.by_rate * along * touch.by_point.dot(&sweeps[a].xy());
        let column = core * arm + touch.by_point * turning;
        let row = core.tr_mul(arm);
        for k in 0..2 {
            block[(k, 4 + a)] += column[k];
            block[(4 + a, k)] += row[k];
        }
        for (b, other) in arms.iter().enumerate() {
            let bend = bends[a + b].xy() * along;
            let turning = point.by_rate * along * touch.by_point.dot(&sweeps[b].xy());
            block[(4 + a, 4 + b)] += arm.dot(&(core * other))
                + arm.dot(&touch.by_point) * turning
                + point.force * touch.by_point.dot(&bend);
        }
    }
}

fn add_border(
    matrix: &mut Bordered,
    block: usize,
    k: usize,
    (column, row): (&V2, &V2),
    arms: &[V2; 2],
) {
    for r in 0..2 {
        matrix.add_right(block, r, k, column[r]);
        matrix.add_bottom(block, k, r, row[r]);
    }
    for (a, arm) in arms.iter().enumerate() {
        matrix.add_right(block, 4 + a, k, column.dot(arm));
        matrix.add_bottom(block, k, 4 + a, row.dot(arm));
    }
}

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
