//! Tangent of the joint that holds a rope on its head: the one joint that couples a cylinder with the
//! beam angle and the head's modes.
use crate::linear::Bordered;
use crate::math::elementary::sin_cos;
use crate::model::chain::{Column, EndTangent};
use crate::model::links::Instant;
use crate::model::{MAX_MODES, Machine, pose::Pose};
use nalgebra::Vector3;

type V3 = Vector3<f64>;

/// The joint between the last cylinder (J) and the head (I).
pub(super) struct Anchor<'a> {
    pub(super) chain: usize,
    /// Block of the last cylinder.
    pub(super) block: usize,
    pub(super) end: &'a EndTangent,
    /// Force on the head \[N\].
    pub(super) force: V3,
    /// The last cylinder.
    pub(super) pose: &'a Pose,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    pub(super) fn anchor_tangent(
        &self,
        anchor: &Anchor<'_>,
        at: &Instant<'_>,
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        let &Anchor {
            chain,
            block,
            end,
            force: F,
            pose,
        } = anchor;
        let (by_head, by_cylinder) = (&end.by_body, &end.by_cylinder);
        let beam = self.layout.beam();
        let (s, c) = sin_cos(at.q[beam]);
        let rate = at.v[beam];
        let z = V3::z();
        // deflection of the anchor in W, its modes and its rate
        let mut shapes = [V3::zeros(); MAX_MODES];
        let modes = if chain == 0 { self.layout.modes } else { 0 };
        let (mut p, mut deflection_rate) = (V3::zeros(), V3::zeros());
        for k in 0..modes {
            let [x, y] = self.anchor_shape[k];
            shapes[k] = V3::new(c * x - s * y, s * x + c * y, 0.0);
            p += shapes[k] * at.q[self.layout.mode(k)];
            deflection_rate += shapes[k] * at.v[self.layout.mode(k)];
        }
        let zp = z.cross(&p);
        // velocity of the reference point: deflection_rate + rate z x p
        let by_angle: Column = std::array::from_fn(|r| {
            by_head.p[r] * zp
                + by_head.v[r] * (z.cross(&deflection_rate) + zp * gamma + z.cross(&zp) * rate)
                + by_head.a[r] * z
                + by_head.w[r] * z * gamma
        });
        let by_mode = |k: usize| -> Column {
            std::array::from_fn(|r| {
                by_head.p[r] * shapes[k]
                    + by_head.v[r] * (shapes[k] * gamma + z.cross(&shapes[k]) * rate)
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
        for (k, &full) in kept.iter().enumerate() {
            let column = by_cylinder.column(full);
            matrix.add_bottom(block, 0, k, -beam_row(&column));
            for (row, shape) in shapes[..modes].iter().enumerate() {
                matrix.add_bottom(block, 1 + row, k, -column[0].dot(shape));
            }
        }
    }
}
