//! Tangent of a chain's contact, added to two matrices at once: without its rate-dependent part, and
//! complete.
//!
//! With the derivatives `G` of a contact point's penetration with respect to the coordinates, and `c` of its
//! force with respect to the penetration's rate, the rate-dependent part is `c G G^T`, without any second
//! derivatives.
use super::contact_point::{BORDER, Derivatives, FEW};
use super::contact_tangent::{Sums, Tangent};
use super::parts::Chain;
use super::points::Points;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::contact::Surface;
use crate::model::layout::Motion;
use crate::model::pose::{InPlane, PlanePose};
use pulp::{Arch, Simd, WithSimd};

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the contact's negative stiffness `-K` to the first matrix and its `-gamma D - K`, with damping D,
    /// to the second.
    pub(crate) fn add_contact_stiffness_and_tangent(
        &self,
        on: (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        matrices: [&mut Bordered; 2],
    ) {
        let border = matrices[0].border().min(on.0.modes() + 1);
        match border {
            0..=1 => self.add_parts_within::<1>(on, state, gamma, (matrices, border)),
            2..=FEW => self.add_parts_within::<FEW>(on, state, gamma, (matrices, border)),
            _ => self.add_parts_within::<BORDER>(on, state, gamma, (matrices, border)),
        }
    }

    fn add_parts_within<const B: usize>(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        (matrices, border): ([&mut Bordered; 2], usize),
    ) {
        let tangent = Tangent::<B> {
            chain: self,
            surface,
            law,
            gamma: 0.0,
            border,
            corner: [[0.0; B]; B],
        };
        let points = &state.points;
        match self.motion {
            Motion::Plane => Arch::new().dispatch(Parts {
                tangent,
                gamma,
                points,
                poses: &state.plane,
                matrices,
            }),
            Motion::Space => add_parts(tangent, gamma, points, &state.poses, matrices),
        }
    }
}

/// Arguments of `add_parts` for a chain in the plane, compiled separately for each SIMD instruction set.
struct Parts<'a, 'm, const B: usize> {
    tangent: Tangent<'a, B>,
    gamma: f64,
    points: &'a Points,
    poses: &'a [PlanePose],
    matrices: [&'m mut Bordered; 2],
}

impl<const B: usize> WithSimd for Parts<'_, '_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        add_parts(
            self.tangent,
            self.gamma,
            self.points,
            self.poses,
            self.matrices,
        );
    }
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_parts<const A: usize, const B: usize>(
    mut tangent: Tangent<'_, B>,
    gamma: f64,
    points: &Points,
    poses: &[impl InPlane<A>],
    [stiffness, matrix]: [&mut Bordered; 2],
) {
    let seen = (tangent.surface, 0.0, tangent.border);
    let mut corner = [[0.0; B]; B];
    for (k, &j) in points.cylinders().iter().enumerate() {
        if points.loaded_points(k).next().is_none() {
            continue;
        }
        let (mut sums, mut damped) = (Sums::zero(), Sums::zero());
        for i in points.loaded_points(k) {
            let touch = points.contact_point((k, i), tangent.surface, tangent.law);
            let point = Derivatives::new(seen, &poses[j], &touch);
            tangent.add_point(&point, &touch, &poses[j], &mut sums);
            let by_rate = gamma * touch.law.by_rate;
            add_damping::<A, B>(&point, by_rate, &mut damped, &mut corner[..seen.2]);
        }
        let block = tangent.chain.first + j;
        tangent.add_sums::<A>(block, &sums, stiffness);
        sums.add_damping(&damped);
        tangent.add_sums::<A>(block, &sums, matrix);
    }
    tangent.add_corner(stiffness);
    let rows = tangent.corner.as_flattened_mut().iter_mut();
    for (entry, damped) in rows.zip(corner.as_flattened()) {
        *entry += damped;
    }
    tangent.add_corner(matrix);
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
