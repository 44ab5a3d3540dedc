//! A chain's contact in two matrices, of places and of rates apart.
//!
//! With the derivatives `G` of a point's penetration and `c` of its force by the penetration's rate, the
//! rates' part is `c G G^T`: it bends nothing.
use super::contact_point::{BORDER, Derivatives, FEW};
use super::contact_tangent::{Sums, Tangent};
use super::parts::Chain;
use super::points::Points;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::contact::Surface;
use crate::model::layout::Motion;
use crate::model::pose::InPlane;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the contact's `-K` to the first matrix and its `-D` to the second.
    pub(crate) fn add_contact_parts(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        matrices: [&mut Bordered; 2],
    ) {
        let border = matrices[0].border().min(surface.modes() + 1);
        let on = (surface, law);
        match border {
            0..=1 => self.add_parts_within::<1>(on, state, (matrices, border)),
            2..=FEW => self.add_parts_within::<FEW>(on, state, (matrices, border)),
            _ => self.add_parts_within::<BORDER>(on, state, (matrices, border)),
        }
    }

    fn add_parts_within<const B: usize>(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        (matrices, border): ([&mut Bordered; 2], usize),
    ) {
        let mut parts = [(); 2].map(|()| Tangent::<B> {
            chain: self,
            surface,
            law,
            gamma: 0.0,
            border,
            corner: [[0.0; B]; B],
        });
        match self.motion {
            Motion::Plane => add_parts(&mut parts, &state.points, &state.plane, matrices),
            Motion::Space => add_parts(&mut parts, &state.points, &state.poses, matrices),
        }
    }
}

fn add_parts<const A: usize, const B: usize>(
    [stiff, damped]: &mut [Tangent<'_, B>; 2],
    points: &Points,
    poses: &[impl InPlane<A>],
    [stiffness, damping]: [&mut Bordered; 2],
) {
    let seen = (stiff.surface, 0.0, stiff.border);
    for (k, &j) in points.cylinders().iter().enumerate() {
        if points.touching(k).next().is_none() {
            continue;
        }
        let mut sums = [Sums::zero(), Sums::zero()];
        for i in points.touching(k) {
            let touch = points.touch((k, i), stiff.surface, stiff.law);
            let point = Derivatives::new(seen, &poses[j], &touch);
            stiff.add_point(&point, &touch, &poses[j], &mut sums[0]);
            let corner = &mut damped.corner[..stiff.border];
            add_damping::<A, B>(&point, touch.law.by_rate, &mut sums[1], corner);
        }
        let block = stiff.chain.first + j;
        stiff.add_sums::<A>(block, &sums[0], stiffness);
        sums[1].bottom = sums[1].right;
        damped.add_sums::<A>(block, &sums[1], damping);
    }
    stiff.add_corner(stiffness);
    damped.add_corner(damping);
}

/// Adds `c G G^T` of a point to the sums of its cylinder, without the rows of the border, and to the corner.
#[inline]
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
