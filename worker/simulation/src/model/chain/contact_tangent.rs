//! Tangent of a chain's contact with an arc.
//!
//! For the force `Q = -f grad d` of one Gauss point, `-dQ = grad d (df)^T + f H dq` with `df = (f_d + gamma
//! c) grad d + c H q'`: `f_d` and `c` are the law's derivatives with respect to penetration and rate, `H` the
//! second derivatives of the penetration.
//!
//! The coordinates of a point are those of its cylinder that move it (`x`, `y` and the angles that turn the
//! axis), then those of the border. With the derivatives `G` of the penetration and `F` of the force with
//! respect to all of them, a point adds `G F^T` and the force times the second derivatives of the
//! penetration.
use super::contact_point::{BORDER, Derivatives, FEW, OWN};
use super::parts::Chain;
use super::points::{ContactPoint, Points};
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::contact::Surface;
use crate::model::layout::Motion;
use crate::model::pose::InPlane;

/// Accumulator for the contact tangent of one chain, with room for `B` border coordinates (beam angle,
/// modes).
pub(super) struct Tangent<'a, const B: usize> {
    pub(super) chain: &'a Chain,
    pub(super) surface: &'a Surface<'a>,
    pub(super) law: &'a Impact,
    pub(super) gamma: f64,
    /// Number of border coordinates (beam angle, modes) included.
    pub(super) border: usize,
    pub(super) corner: [[f64; B]; B],
}

/// Tangent matrix of one cylinder's contact, summed over its contact points.
pub(super) struct Sums<const B: usize> {
    pub(super) own: [[f64; OWN]; OWN],
    /// Sums in the rows of the cylinder and the columns of the border.
    pub(super) right: [[f64; B]; OWN],
    /// Sums in the rows of the border and the columns of the cylinder, stored transposed.
    pub(super) bottom: [[f64; B]; OWN],
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the tangent of the chain's contact to the matrix: to the cylinders' blocks and to the border, if
    /// there is one.
    pub(crate) fn add_contact_tangent(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        let border = matrix.border().min(surface.modes() + 1);
        let on = (surface, law);
        match border {
            0..=1 => self.add_tangent_within::<1>(on, state, gamma, (matrix, border)),
            2..=FEW => self.add_tangent_within::<FEW>(on, state, gamma, (matrix, border)),
            _ => self.add_tangent_within::<BORDER>(on, state, gamma, (matrix, border)),
        }
    }

    fn add_tangent_within<const B: usize>(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        (matrix, border): (&mut Bordered, usize),
    ) {
        let mut tangent = Tangent {
            chain: self,
            surface,
            law,
            gamma,
            border,
            corner: [[0.0; B]; B],
        };
        let points = &state.points;
        match self.motion {
            Motion::Plane => tangent.add_cylinders(points, &state.plane, matrix),
            Motion::Space => tangent.add_cylinders(points, &state.poses, matrix),
        }
        tangent.add_corner(matrix);
    }
}

impl<const B: usize> Sums<B> {
    pub(super) const fn zero() -> Self {
        Self {
            own: [[0.0; OWN]; OWN],
            right: [[0.0; B]; OWN],
            bottom: [[0.0; B]; OWN],
        }
    }

    /// Adds the rate-dependent part of the tangent, which is symmetric: its border rows are taken from its
    /// border columns.
    pub(super) fn add_damping(&mut self, damped: &Self) {
        let pairs = [
            (self.own.as_flattened_mut(), damped.own.as_flattened()),
            (self.right.as_flattened_mut(), damped.right.as_flattened()),
            (self.bottom.as_flattened_mut(), damped.right.as_flattened()),
        ];
        for (sums, damped) in pairs {
            for (sum, damped) in sums.iter_mut().zip(damped) {
                *sum += damped;
            }
        }
    }
}

impl<const B: usize> Tangent<'_, B> {
    fn add_cylinders<const A: usize>(
        &mut self,
        points: &Points,
        poses: &[impl InPlane<A>],
        matrix: &mut Bordered,
    ) {
        for (k, &j) in points.cylinders().iter().enumerate() {
            if points.loaded_points(k).next().is_none() {
                continue;
            }
            let mut sums = Sums::zero();
            for i in points.loaded_points(k) {
                let touch = points.contact_point((k, i), self.surface, self.law);
                let seen = (self.surface, self.gamma, self.border);
                let point = Derivatives::new(seen, &poses[j], &touch);
                self.add_point(&point, &touch, &poses[j], &mut sums);
            }
            self.add_sums::<A>(self.chain.first + j, &sums, matrix);
        }
    }

    pub(super) fn add_corner(&self, matrix: &mut Bordered) {
        for row in 0..self.border {
            for column in 0..self.border {
                matrix.add_corner(row, column, self.corner[row][column]);
            }
        }
    }

    /// Adds the sums over one cylinder's contact points to the cylinder's block and to the border of the
    /// matrix.
    pub(super) fn add_sums<const A: usize>(
        &self,
        block: usize,
        sums: &Sums<B>,
        matrix: &mut Bordered,
    ) {
        let rows: [usize; OWN] = std::array::from_fn(|k| {
            if k < 2 {
                k
            } else {
                self.chain.motion.width() - A + k - 2
            }
        });
        let rows = &rows[..2 + A];
        let (own, border) = (&sums.own, (&sums.right, &sums.bottom));
        match matrix {
            Bordered::Plane(matrix) => matrix.add_touching(block, rows, own, border, self.border),
            Bordered::Space(matrix) => matrix.add_touching(block, rows, own, border, self.border),
        }
    }

    /// Adds the tangent of one contact point to the sums of its cylinder and to the part within the border.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn add_point<const A: usize>(
        &mut self,
        point: &Derivatives<B>,
        touch: &ContactPoint,
        pose: &impl InPlane<A>,
        sums: &mut Sums<B>,
    ) {
        add_own::<A, B>(point, touch, sums);
        for a in 0..A {
            for b in 0..A {
                let bend = pose.axis_by_twice(a, b) * touch.along;
                sums.own[2 + a][2 + b] += touch.law.force * touch.by_point.dot(&bend);
            }
        }
        self.add_border::<A>(point, touch, sums);
    }

    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    fn add_border<const A: usize>(
        &mut self,
        point: &Derivatives<B>,
        touch: &ContactPoint,
        sums: &mut Sums<B>,
    ) {
        let (curvature, force) = (&touch.curvature, touch.law.force);
        let (angle_by_point, angle_by_beam) = curvature.angle_by;
        let Derivatives {
            own,
            own_force,
            moved,
            gradient,
            force_by,
            slope,
        } = point;
        for r in 0..2 + A {
            let turned = force * angle_by_point.dot(&moved[r]);
            let (right, bottom) = (&mut sums.right[r], &mut sums.bottom[r]);
            right[0] += own[r] * force_by[0] + force * curvature.mixed.dot(&moved[r]);
            bottom[0] += own_force[r] * gradient[0] + force * curvature.mixed.dot(&moved[r]);
            // beyond the border everything is zero
            for k in 1..B {
                right[k] += own[r] * force_by[k] + turned * slope[k];
                bottom[k] += own_force[r] * gradient[k] + turned * slope[k];
            }
        }
        for (k, row) in self.corner[..self.border].iter_mut().enumerate() {
            for (entry, force_by) in row.iter_mut().zip(force_by) {
                *entry += gradient[k] * force_by;
            }
        }
        self.corner[0][0] += force * curvature.beam;
        for k in 1..self.border {
            let bend = force * angle_by_beam * slope[k];
            self.corner[0][k] += bend;
            self.corner[k][0] += bend;
        }
    }
}

/// Adds a contact point's tangent to its cylinder's own block, except for the second derivatives of the
/// cylinder's axis.
#[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
#[inline(always)]
fn add_own<const A: usize, const B: usize>(
    point: &Derivatives<B>,
    touch: &ContactPoint,
    sums: &mut Sums<B>,
) {
    let bends = touch.curvature.point * touch.law.force;
    for r in 0..2 + A {
        let bent = bends * point.moved[r];
        for c in 0..2 + A {
            sums.own[r][c] += point.own[r] * point.own_force[c] + bent.dot(&point.moved[c]);
        }
    }
}
