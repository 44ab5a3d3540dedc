//! Tangent of the anchor, the joint that fixes a rope's end to its head: the one joint that couples a
//! cylinder with the beam angle and the head's modes.
//!
//! The rope's end, at `a` in the beam frame, moves to `P = B (a + sum u_k q_k)` and turns by the beam's
//! rotation `B` and by `R_t(sum t_k q_k) R_r(sum r_k q_k)`, with mode shapes `u_k`, `t_k`, `r_k` and modal
//! coordinates `q_k`. With `S_k = B u_k` and `W_k = t_k d_t + r_k d_r`, where the axes `d` are those of
//! `EndRotation::axes`, the anchor's force and torque do the work `Q_k = F . S_k + tau . W_k` on a mode and
//! `Q = (P x F + tau) . z` on the beam.
use crate::element::bushing::{LinkLoad, LinkTangent};
use crate::linear::Bordered;
use crate::math::elementary::sin_cos;
use crate::model::chain::tangent::{Column, EndTangent};
use crate::model::layout::MAX_MODES;
use crate::model::machine::Machine;
use crate::model::machine_state::MachineState;
use crate::model::parallel_ropes::{AnchorShape, HeadResponse};
use crate::model::pose::Pose;
use nalgebra::Vector3;

type V3 = Vector3<f64>;

/// Joint between a rope's last cylinder (J) and the head (I), with its load and derivatives.
pub(super) struct Anchor<'a> {
    pub(super) chain: usize,
    /// Index of the matrix block of the rope's last cylinder.
    pub(super) block: usize,
    pub(super) end: &'a EndTangent,
    /// Force and torque of the anchor joint on the head.
    pub(super) load: &'a LinkLoad,
    /// Pose of the rope's last cylinder.
    pub(super) pose: &'a Pose,
}

impl Machine {
    pub(super) fn anchor_tangent(
        &self,
        anchor: &Anchor<'_>,
        at: &MachineState<'_>,
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        let &Anchor {
            chain,
            block,
            end,
            load,
            pose,
        } = anchor;
        let F = load.force;
        let (by_head, by_cylinder) = (&end.by_body, &end.by_cylinder);
        let beam = self.layout.beam();
        let rate = at.v[beam];
        let z = V3::z();
        let face = self.faces.get(chain);
        let modes = face.map_or(0, |face| face.anchor.len());
        let (shapes, mut p, deflection_rate) = self.anchor_shapes(face, at);
        let turning = face.and_then(|face| self.turning(face, chain, at));
        if turning.is_some() {
            p = self.anchor_marker(chain, at).p;
        }
        let zp = z.cross(&p);
        let moving = AnchorMotion {
            p,
            deflection_rate,
            rate,
            gamma,
        };
        let by_angle = moving.by_angle(by_head, turning.as_ref());
        let by_mode = |k: usize| -> Column {
            std::array::from_fn(|r| {
                let moved = by_head.p[r] * shapes[k]
                    + by_head.v[r] * (shapes[k] * gamma + z.cross(&shapes[k]) * rate);
                turning.as_ref().map_or(moved, |turning| {
                    let axis = turning.axes[k];
                    moved + by_head.a[r] * axis + by_head.w[r] * (axis * gamma + turning.drift(k))
                })
            })
        };
        let beam_row = |c: &Column| c[1].z + p.x * c[0].y - p.y * c[0].x;
        let angular = pose.angular();
        let kept = self.layout.motion.kept();

        for k in 0..=modes {
            let column = if k == 0 { by_angle } else { by_mode(k - 1) };
            let turned = angular.tr_mul(&column[2]);
            for (row, &full) in kept.iter().enumerate() {
                let entry = if full < 3 {
                    column[0][full]
                } else {
                    -turned[full - 3]
                };
                matrix.add_right(block, row, k, entry);
            }
            let moved = if k == 0 { zp } else { shapes[k - 1] };
            let beam_entry = beam_row(&column) + (moved.x * F.y - moved.y * F.x);
            matrix.add_corner(0, k, -beam_entry);
            for (row, shape) in shapes[..modes].iter().enumerate() {
                let mut entry = column[0].dot(shape);
                if k == 0 {
                    entry += F.dot(&z.cross(shape));
                }
                if let Some(turning) = &turning {
                    let axis = turning.axes[row];
                    let bent = k
                        .checked_sub(1)
                        .map_or_else(|| z.cross(&axis), |mode| turning.bend(row, mode));
                    entry += column[1].dot(&axis) + load.torque_i.dot(&bent);
                }
                matrix.add_corner(1 + row, k, -entry);
            }
        }
        for (k, &full) in kept.iter().enumerate() {
            let column = by_cylinder.column(full);
            matrix.add_bottom(block, 0, k, -beam_row(&column));
            for (row, shape) in shapes[..modes].iter().enumerate() {
                let mut entry = column[0].dot(shape);
                if let Some(turning) = &turning {
                    entry += column[1].dot(&turning.axes[row]);
                }
                matrix.add_bottom(block, 1 + row, k, -entry);
            }
        }
    }

    /// Returns the mode shapes at the anchor in the world frame W, and the displacement and the velocity of
    /// the anchor's reference point due to the modes.
    fn anchor_shapes(
        &self,
        face: Option<&HeadResponse>,
        at: &MachineState<'_>,
    ) -> ([V3; MAX_MODES], V3, V3) {
        let (s, c) = sin_cos(at.q[self.layout.beam()]);
        let mut shapes = [V3::zeros(); MAX_MODES];
        let (mut p, mut rate) = (V3::zeros(), V3::zeros());
        for (k, shape) in face.iter().flat_map(|face| face.anchor.iter().enumerate()) {
            let [x, y, along] = shape.moves;
            shapes[k] = V3::new(c * x - s * y, s * x + c * y, along);
            p += shapes[k] * at.q[self.layout.mode(k)];
            rate += shapes[k] * at.v[self.layout.mode(k)];
        }
        (shapes, p, rate)
    }

    fn turning<'a>(
        &self,
        face: &'a HeadResponse,
        chain: usize,
        at: &MachineState<'_>,
    ) -> Option<AnchorRotation<'a>> {
        let turn = self.end_rotation(face, self.arc(chain).anchor, at)?;
        let [t, r] = turn.axes();
        let mut axes = [V3::zeros(); MAX_MODES];
        for (axis, shape) in axes.iter_mut().zip(&face.anchor) {
            *axis = t * shape.turns[0] + r * shape.turns[1];
        }
        Some(AnchorRotation {
            shapes: &face.anchor,
            axes,
            velocity: turn.velocity(),
            by_tilt: turn.axis_by_tilt(),
            second_rate: turn.second_rate(),
        })
    }
}

/// Motion of the anchor's reference point: the point of the head to which a rope's end is fixed.
struct AnchorMotion {
    /// Position of the point relative to the beam's pivot, in the world frame W \[m\].
    p: V3,
    /// Velocity of the point due to the modes alone, in the world frame W [m/s].
    deflection_rate: V3,
    /// Angular velocity of the beam [rad/s].
    rate: f64,
    /// Factor by which a rate changes with its coordinate in the implicit integration stage [1/s].
    gamma: f64,
}

impl AnchorMotion {
    /// Returns the derivative of the anchor joint's load with respect to the beam angle.
    fn by_angle(&self, by_head: &LinkTangent, turning: Option<&AnchorRotation<'_>>) -> Column {
        let &Self {
            p,
            deflection_rate,
            rate,
            gamma,
        } = self;
        let z = V3::z();
        let zp = z.cross(&p);
        // velocity of the reference point: deflection_rate + rate z x p
        let mut by_angle: Column = std::array::from_fn(|r| {
            by_head.p[r] * zp
                + by_head.v[r] * (z.cross(&deflection_rate) + zp * gamma + z.cross(&zp) * rate)
                + by_head.a[r] * z
                + by_head.w[r] * z * gamma
        });
        if let Some(turning) = turning {
            let further = z.cross(&turning.velocity);
            for (r, by_angle) in by_angle.iter_mut().enumerate() {
                *by_angle += by_head.w[r] * further;
            }
        }
        by_angle
    }
}

/// Rotation of the anchor (a rope's fixed end) relative to the beam, caused by the head's modes.
struct AnchorRotation<'a> {
    shapes: &'a [AnchorShape],
    /// Rotation axes `W_k` of the modes at the anchor, in the world frame W.
    axes: [V3; MAX_MODES],
    /// Angular velocity of the anchor relative to the beam [rad/s].
    velocity: V3,
    /// Derivative of the axis of the anchor's second rotation (`r`) with respect to the angle of the first
    /// (`t`).
    by_tilt: V3,
    second_rate: f64,
}

impl AnchorRotation<'_> {
    /// Returns the derivative of the rotation axis `W_row` of mode `row` with respect to the coordinate of
    /// `mode`.
    fn bend(&self, row: usize, mode: usize) -> V3 {
        self.by_tilt * (self.shapes[row].turns[1] * self.shapes[mode].turns[0])
    }

    /// Returns the derivative of the anchor's angular velocity with respect to the coordinate of `mode` at
    /// constant rates.
    fn drift(&self, mode: usize) -> V3 {
        self.by_tilt * (self.second_rate * self.shapes[mode].turns[0])
    }
}
