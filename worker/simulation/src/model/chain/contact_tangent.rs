//! Stiffness and damping of a chain's contact with an arc.
//!
//! For the force `Q = -f grad d` of one Gauss point, `-dQ = grad d (df)^T + f H dq` with `df = f_d grad d + c
//! H q'` by the coordinates and `c grad d` by their rates: `f_d` and `c` are the law's derivatives with respect
//! to penetration and rate, `H` the second derivatives of the penetration.
//!
//! The coordinates of a point are those of its cylinder that move it (`x`, `y` and the angles that turn the
//! axis), then those of the border. With the derivatives `G` of the penetration and `F` of the force with
//! respect to all of them, a point adds `G F^T` and the force times the second derivatives of the penetration
//! to the stiffness `K`, and `c G G^T` to the damping `D`. A matrix `K + gamma D` alone takes `F + gamma c G`
//! in place of `F`, which saves the sums of `D`.
use super::contact_point::{BORDER, Derivatives, FEW, OWN};
use super::parts::Chain;
use super::points::{ContactPoint, Points};
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::contact::Surface;
use crate::model::layout::Motion;
use crate::model::pose::InPlane;
use pulp::{Arch, Simd, WithSimd};

/// Accumulator for the contact tangent of one chain, with room for `B` border coordinates (beam angle,
/// modes).
struct Tangent<'a, const B: usize> {
    chain: &'a Chain,
    surface: &'a Surface<'a>,
    law: &'a Impact,
    /// Number of border coordinates (beam angle, modes) included.
    border: usize,
    corner: [[f64; B]; B],
}

/// Tangent matrix of one cylinder's contact, summed over its contact points.
struct Sums<const B: usize> {
    own: [[f64; OWN]; OWN],
    /// Sums in the rows of the cylinder and the columns of the border.
    right: [[f64; B]; OWN],
    /// Sums in the rows of the border and the columns of the cylinder, stored transposed.
    bottom: [[f64; B]; OWN],
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds `K + gamma D` of the chain's contact to the second matrix and, if there is one, `K` alone to the
    /// first: to the cylinders' blocks and to the border, if there is one.
    pub(crate) fn add_contact_tangent(
        &self,
        on: (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        matrices: (Option<&mut Bordered>, &mut Bordered),
    ) {
        let border = matrices.1.border().min(on.0.modes() + 1);
        match border {
            0..=1 => self.add_tangent_within::<1>(on, state, gamma, (matrices, border)),
            2..=FEW => self.add_tangent_within::<FEW>(on, state, gamma, (matrices, border)),
            _ => self.add_tangent_within::<BORDER>(on, state, gamma, (matrices, border)),
        }
    }

    fn add_tangent_within<const B: usize>(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        (matrices, border): ((Option<&mut Bordered>, &mut Bordered), usize),
    ) {
        let tangent = Tangent::<B> {
            chain: self,
            surface,
            law,
            border,
            corner: [[0.0; B]; B],
        };
        Arch::new().dispatch(AddTangent {
            tangent,
            gamma,
            state,
            matrices,
        });
    }
}

/// Evaluation of the contact tangent of a chain, compiled for each set of instructions.
struct AddTangent<'a, 'm, const B: usize> {
    tangent: Tangent<'a, B>,
    gamma: f64,
    state: &'a ChainState,
    matrices: (Option<&'m mut Bordered>, &'m mut Bordered),
}

impl<const B: usize> WithSimd for AddTangent<'_, '_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            tangent,
            gamma,
            state,
            matrices,
        } = self;
        let points = &state.points;
        let plane = |j: usize| state.plane.get(j);
        let space = |j: usize| state.poses[j];
        match (tangent.chain.motion, matrices) {
            (Motion::Plane, (None, matrix)) => tangent.add_sum(gamma, points, plane, matrix),
            (Motion::Space, (None, matrix)) => tangent.add_sum(gamma, points, space, matrix),
            (Motion::Plane, (Some(stiffness), matrix)) => {
                tangent.add_both(gamma, points, plane, [stiffness, matrix]);
            }
            (Motion::Space, (Some(stiffness), matrix)) => {
                tangent.add_both(gamma, points, space, [stiffness, matrix]);
            }
        }
    }
}

impl<const B: usize> Sums<B> {
    const fn zero() -> Self {
        Self {
            own: [[0.0; OWN]; OWN],
            right: [[0.0; B]; OWN],
            bottom: [[0.0; B]; OWN],
        }
    }

    /// Adds the rate-dependent part of the tangent, which is symmetric: its border rows are taken from its
    /// border columns.
    fn add_damping(&mut self, damped: &Self) {
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
    /// Adds `K + gamma D` to the matrix.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn add_sum<const A: usize, P: InPlane<A>>(
        mut self,
        gamma: f64,
        points: &Points,
        pose: impl Fn(usize) -> P,
        matrix: &mut Bordered,
    ) {
        for (k, j) in points.touching().enumerate() {
            if points.loaded_points(k).next().is_none() {
                continue;
            }
            let pose = pose(j);
            let mut sums = Sums::zero();
            for i in points.loaded_points(k) {
                let touch = points.contact_point((k, i), self.surface, self.law);
                let mut point = Derivatives::new((self.surface, self.border), &pose, &touch);
                point.add_rates(gamma * touch.law.damping[0][0]);
                self.add_point(&point, &touch, &pose, &mut sums);
            }
            self.add_sums::<A>(self.chain.first + j, &sums, matrix);
        }
        self.add_corner(matrix);
    }

    /// Adds `K` to the first matrix and `K + gamma D` to the second.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn add_both<const A: usize, P: InPlane<A>>(
        mut self,
        gamma: f64,
        points: &Points,
        pose: impl Fn(usize) -> P,
        [stiffness, matrix]: [&mut Bordered; 2],
    ) {
        let mut corner = [[0.0; B]; B];
        for (k, j) in points.touching().enumerate() {
            if points.loaded_points(k).next().is_none() {
                continue;
            }
            let pose = pose(j);
            let (mut sums, mut damped) = (Sums::zero(), Sums::zero());
            for i in points.loaded_points(k) {
                let touch = points.contact_point((k, i), self.surface, self.law);
                let point = Derivatives::new((self.surface, self.border), &pose, &touch);
                let by_rate = gamma * touch.law.damping[0][0];
                add_damping::<A, B>(&point, by_rate, &mut damped, &mut corner[..self.border]);
                self.add_point(&point, &touch, &pose, &mut sums);
            }
            let block = self.chain.first + j;
            self.add_sums::<A>(block, &sums, stiffness);
            sums.add_damping(&damped);
            self.add_sums::<A>(block, &sums, matrix);
        }
        self.add_corner(stiffness);
        let rows = self.corner.as_flattened_mut().iter_mut();
        for (entry, damped) in rows.zip(corner.as_flattened()) {
            *entry += damped;
        }
        self.add_corner(matrix);
    }

    fn add_corner(&self, matrix: &mut Bordered) {
        for row in 0..self.border {
            for column in 0..self.border {
                matrix.add_corner(row, column, self.corner[row][column]);
            }
        }
    }

    /// Adds the sums over one cylinder's contact points to the cylinder's block and to the border of the
    /// matrix.
    fn add_sums<const A: usize>(&self, block: usize, sums: &Sums<B>, matrix: &mut Bordered) {
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
    fn add_point<const A: usize>(
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
                sums.own[2 + a][2 + b] += touch.law.force[0] * touch.by_point.dot(&bend);
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
        let (curvature, force) = (&touch.curvature, touch.law.force[0]);
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
    let bends = touch.curvature.point * touch.law.force[0];
    for r in 0..2 + A {
        let bent = bends * point.moved[r];
        for c in 0..2 + A {
            sums.own[r][c] += point.own[r] * point.own_force[c] + bent.dot(&point.moved[c]);
        }
    }
}

/// Adds a contact point's rate-dependent tangent `c G G^T` to the sums of its cylinder (without the border's
/// rows) and to the part of the matrix within the border.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_damping<const A: usize, const B: usize>(
    point: &Derivatives<B>,
    c: f64,
    sums: &mut Sums<B>,
    corner: &mut [[f64; B]],
) {
    for r in 0..2 + A {
        let by = c * point.own[r];
        for k in 0..2 + A {
            sums.own[r][k] += by * point.own[k];
        }
        for (sum, gradient) in sums.right[r].iter_mut().zip(point.gradient) {
            *sum += by * gradient;
        }
    }
    for (row, by) in corner.iter_mut().zip(point.gradient) {
        for (sum, gradient) in row.iter_mut().zip(point.gradient) {
            *sum += c * by * gradient;
        }
    }
}
