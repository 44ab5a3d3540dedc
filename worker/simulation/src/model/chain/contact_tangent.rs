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
use super::contact_group::{Each, Group, read, write};
use super::contact_point::{BORDER, FEW, ModeShapes, OWN, PointMotion, PointTangent};
use super::parts::Chain;
use super::points::Points;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::element::law::ForceLaw;
use crate::linear::Bordered;
use crate::math::real::{Real, Vector, WIDEST};
use crate::model::contact::{POINTS, Surface};
use crate::model::layout::Motion;
use crate::model::pose::Pose;
use pulp::{Arch, Simd, WithSimd};

/// Assembly of the contact tangent of one chain, with room for `B` border coordinates (beam angle, modes).
/// `BOTH`: `K` and `K + gamma D` into two matrices, otherwise `K + gamma D` alone.
struct Tangent<'a, const B: usize, const BOTH: bool> {
    chain: &'a Chain,
    surface: &'a Surface<'a>,
    law: &'a Impact,
    gamma: f64,
    /// Number of border coordinates (beam angle, modes) included.
    border: usize,
    /// Sums within the border: of `K` or of `K + gamma D`, and of `gamma D` alone.
    corner: [[[f64; B]; B]; 2],
}

/// Tangent matrix of one cylinder's contact, summed over its contact points.
#[derive(Clone, Copy)]
struct Sums<const B: usize> {
    own: [[f64; OWN]; OWN],
    /// Sums in the rows of the cylinder and the columns of the border.
    right: [[f64; B]; OWN],
    /// Sums in the rows of the border and the columns of the cylinder, stored transposed.
    bottom: [[f64; B]; OWN],
}

/// Quantities of a contact point from which the sums of its cylinder follow: `T` is a number, or one for each
/// of some neighbouring cylinders.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Terms<T> {
    /// Derivatives of penetration and force with respect to the cylinder's coordinates.
    own: [T; OWN],
    own_force: [T; OWN],
    /// Force times the derivatives of the arc angle with respect to these coordinates, and times the second
    /// derivatives of the penetration with respect to them and the beam angle.
    turned: [T; OWN],
    mixed: [T; OWN],
    /// Derivatives of penetration and force with respect to the beam angle.
    by_beam: T,
    force_by_beam: T,
    /// Force times the second derivative of the penetration with respect to the beam angle, and times the
    /// derivative of the arc angle with respect to it.
    beam: T,
    turned_by_beam: T,
    /// Stiffness of the law, derivative of the force with respect to a mode per slope of its shape, and `gamma`
    /// times the damping of the law.
    stiffness: T,
    by_slope: T,
    damping: T,
}

/// Sums over the contact points of neighbouring cylinders: own blocks of `K` or `K + gamma D`, and of `gamma D`
/// alone.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct OwnSums([[[Each; OWN]; OWN]; 2]);

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
        on: (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        ((stiffness, matrix), border): ((Option<&mut Bordered>, &mut Bordered), usize),
    ) {
        if let Some(stiffness) = stiffness {
            let tangent = Tangent::<B, true>::new(self, on, gamma, border);
            tangent.add(state, &mut [stiffness, matrix]);
        } else {
            let tangent = Tangent::<B, false>::new(self, on, gamma, border);
            tangent.add(state, &mut [matrix]);
        }
    }
}

/// Assembly of the contact tangent of a chain in the plane, compiled for each set of instructions.
struct AddPlane<'a, 'm, const B: usize, const BOTH: bool> {
    tangent: &'a mut Tangent<'m, B, BOTH>,
    state: &'a ChainState,
    matrices: &'a mut [&'m mut Bordered],
}

impl<const B: usize, const BOTH: bool> WithSimd for AddPlane<'_, '_, B, BOTH> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.tangent.add_plane(simd, self.state, self.matrices);
    }
}

impl<const B: usize> Sums<B> {
    const ZERO: Self = Self {
        own: [[0.0; OWN]; OWN],
        right: [[0.0; B]; OWN],
        bottom: [[0.0; B]; OWN],
    };

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

impl<'a, const B: usize, const BOTH: bool> Tangent<'a, B, BOTH> {
    const fn new(
        chain: &'a Chain,
        (surface, law): (&'a Surface<'a>, &'a Impact),
        gamma: f64,
        border: usize,
    ) -> Self {
        Self {
            chain,
            surface,
            law,
            gamma,
            border,
            corner: [[[0.0; B]; B]; 2],
        }
    }

    /// Adds the tangent to the matrices, of which the last is that of `K + gamma D`.
    fn add(mut self, state: &ChainState, matrices: &mut [&'a mut Bordered]) {
        match self.chain.motion {
            Motion::Plane => Arch::new().dispatch(AddPlane {
                tangent: &mut self,
                state,
                matrices,
            }),
            Motion::Space => self.add_space(state, matrices),
        }
        self.add_corner(matrices);
    }

    /// Adds the tangent of cylinders in space, one after the other.
    fn add_space(&mut self, state: &ChainState, matrices: &mut [&'a mut Bordered]) {
        let points = &state.points;
        let mut shapes = ModeShapes::ZERO;
        for (k, j) in points.touching().enumerate() {
            if points.loaded_points(k).next().is_none() {
                continue;
            }
            let pose: &Pose = &state.poses[j];
            let mut sums = [Sums::ZERO; 2];
            for i in points.loaded_points(k) {
                let touch = points.contact_point((k, i), self.law);
                let measures = shapes.fill(self.surface, self.border, touch.angle);
                let at = touch.motion::<2>(self.surface, pose, measures);
                let (point, terms) = self.terms(&at);
                let [own, damped] = &mut sums;
                add_own::<_, 4>(&point, &terms, &mut own.own);
                if BOTH {
                    add_own_damping::<_, 4>(&terms, &mut damped.own);
                }
                self.add_border::<4>(&terms, &shapes, &mut sums);
            }
            self.add_sums::<4>(self.chain.first + j, &mut sums, matrices);
        }
    }

    /// Adds the tangent of cylinders in the plane, several side by side.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn add_plane<S: Simd>(
        &mut self,
        simd: S,
        state: &ChainState,
        matrices: &mut [&'a mut Bordered],
    ) {
        let points = &state.points;
        let touching = points.touching();
        let mut shapes = [[ModeShapes::ZERO; POINTS]; WIDEST];
        for (g, group) in points.groups().iter().enumerate() {
            let first = g * WIDEST;
            let lanes = WIDEST.min(touching.len() - first);
            if group.total[..lanes].iter().all(|total| *total == 0.0) {
                continue;
            }
            let mut measures = [[[0.0; WIDEST]; POINTS]; 2];
            if self.surface.bend.is_some() || self.surface.profile.is_some() {
                for lane in 0..lanes {
                    for i in points.loaded_points(first + lane) {
                        let angle = group.angle[i][lane];
                        let found = shapes[lane][i].fill(self.surface, self.border, angle);
                        measures[0][i][lane] = found[0];
                        measures[1][i][lane] = found[1];
                    }
                }
            }
            let mut terms = [Terms::<Each>::default(); POINTS];
            let mut own = OwnSums::default();
            self.fill(simd, (group, points), &measures, (&mut terms, &mut own));
            for lane in 0..lanes {
                if group.total[lane] == 0.0 {
                    continue;
                }
                let mut sums = [Sums::ZERO; 2];
                for (sums, own) in sums.iter_mut().zip(&own.0).take(1 + usize::from(BOTH)) {
                    sums.own = own.map(|row| row.map(|each| each[lane]));
                }
                for i in points.loaded_points(first + lane) {
                    self.add_border::<3>(&terms[i].lane(lane), &shapes[lane][i], &mut sums);
                }
                let block = self.chain.first + touching.start + first + lane;
                self.add_sums::<3>(block, &mut sums, matrices);
            }
        }
    }

    /// Computes the terms of all contact points of neighbouring cylinders in the plane, and the sums of their own
    /// blocks. `measures` are the second derivatives of the surface and the drifts at the points.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn fill<S: Simd>(
        &self,
        simd: S,
        (group, points): (&Group, &Points),
        measures: &[[Each; POINTS]; 2],
        (terms, own): (&mut [Terms<Each>; POINTS], &mut OwnSums),
    ) {
        let zero = Vector::splat(simd, 0.0);
        for k in 0..WIDEST / S::F64_LANES {
            let [axis, sweep] = [
                read_pair(simd, &group.axis, k),
                read_pair(simd, &group.sweep, k),
            ];
            let [toward, velocity] = [
                read_pair(simd, &group.toward, k),
                read_pair(simd, &group.velocity, k),
            ];
            let mut sums = [[[zero; OWN]; OWN]; 2];
            for i in 0..POINTS {
                let (along, share) = points.point(i);
                let law = self.law.response(
                    [read(simd, &group.depth[i], k)],
                    [read(simd, &group.rate[i], k)],
                );
                let at = [toward[0] + axis[0] * along, toward[1] + axis[1] * along];
                let second = read(simd, &measures[0][i], k);
                let slope = read(simd, &group.slope[i], k);
                let outward = read_pair(simd, &group.outward[i], k);
                let motion = PointMotion {
                    along,
                    velocity: [
                        velocity[0] + sweep[0] * along,
                        velocity[1] + sweep[1] * along,
                    ],
                    by_point: [-outward[0], -outward[1]],
                    by_beam: read(simd, &group.by_beam[i], k),
                    curvature: self.surface.curvature(at, [slope, second]),
                    drift: read(simd, &measures[1][i], k),
                    law: law.scaled(share),
                    axis_by: [[-axis[1], axis[0]]],
                    sweep_by: [[-sweep[1], sweep[0]]],
                    axis_by_twice: [[[-axis[0], -axis[1]]]],
                };
                let (point, at) = self.terms(&motion);
                add_own::<_, 3>(&point, &at, &mut sums[0]);
                if BOTH {
                    add_own_damping::<_, 3>(&at, &mut sums[1]);
                }
                at.store(&mut terms[i], k);
            }
            for (to, from) in own.0.iter_mut().zip(sums) {
                for (to, from) in to.iter_mut().zip(from) {
                    for (to, from) in to.iter_mut().zip(from) {
                        write(to, k, from);
                    }
                }
            }
        }
    }

    /// Computes the terms of a contact point.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn terms<T: Real, const A: usize>(
        &self,
        at: &PointMotion<T, A>,
    ) -> (PointTangent<T>, Terms<T>) {
        let point = PointTangent::new(self.surface, at);
        let ([force], curvature) = (at.law.force, &at.curvature);
        let damping = at.law.damping[0][0] * self.gamma;
        let (mut own_force, mut turned, mut mixed) = (point.own_force, point.angle, point.mixed);
        let mut force_by_beam = point.force_by_beam;
        for k in 0..2 + A {
            if !BOTH {
                own_force[k] = own_force[k] + damping * point.own[k];
            }
            turned[k] = force * turned[k];
            mixed[k] = force * mixed[k];
        }
        if !BOTH {
            force_by_beam = force_by_beam + damping * at.by_beam;
        }
        let terms = Terms {
            own: point.own,
            own_force,
            turned,
            mixed,
            by_beam: at.by_beam,
            force_by_beam,
            beam: force * curvature.beam,
            turned_by_beam: force * curvature.angle_by.1,
            stiffness: at.law.stiffness[0][0],
            by_slope: point.force_by_slope,
            damping,
        };
        (point, terms)
    }

    fn add_corner(&self, matrices: &mut [&'a mut Bordered]) {
        let [alone, damped] = &self.corner;
        for (k, matrix) in matrices.iter_mut().enumerate() {
            for row in 0..self.border {
                for column in 0..self.border {
                    let mut entry = alone[row][column];
                    if k == 1 {
                        entry += damped[row][column];
                    }
                    matrix.add_corner(row, column, entry);
                }
            }
        }
    }

    /// Adds the sums over one cylinder's contact points, of the first `R` of its coordinates that move them, to
    /// its block and to the border of the matrices.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn add_sums<const R: usize>(
        &self,
        block: usize,
        sums: &mut [Sums<B>; 2],
        matrices: &mut [&'a mut Bordered],
    ) {
        let width = self.chain.motion.width();
        let rows: [usize; R] =
            std::array::from_fn(|k| if k < 2 { k } else { width - (R - 2) + k - 2 });
        for (k, matrix) in matrices.iter_mut().enumerate() {
            let [sums, damped] = &mut *sums;
            if k == 1 {
                sums.add_damping(damped);
            }
            let (own, border) = (&sums.own, (&sums.right, &sums.bottom));
            match &mut **matrix {
                Bordered::Plane(matrix) => {
                    matrix.add_touching(block, &rows, own, border, self.border);
                }
                Bordered::Space(matrix) => {
                    matrix.add_touching(block, &rows, own, border, self.border);
                }
            }
        }
    }

    /// Adds a contact point to the sums of its cylinder in the rows and columns of the border, and to those within
    /// the border.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn add_border<const R: usize>(
        &mut self,
        at: &Terms<f64>,
        shapes: &ModeShapes<B>,
        [sums, damped]: &mut [Sums<B>; 2],
    ) {
        let c = at.damping;
        let mut gradient = shapes.value;
        gradient[0] = at.by_beam;
        let mut force_by: [f64; B] = std::array::from_fn(|k| {
            let by = gradient[k] * at.stiffness + shapes.slope[k] * at.by_slope;
            if BOTH { by } else { by + c * gradient[k] }
        });
        force_by[0] = at.force_by_beam;
        for r in 0..R {
            let (right, bottom) = (&mut sums.right[r], &mut sums.bottom[r]);
            right[0] += at.own[r] * force_by[0] + at.mixed[r];
            bottom[0] += at.own_force[r] * gradient[0] + at.mixed[r];
            // beyond the border everything is zero
            for k in 1..B {
                right[k] += at.own[r] * force_by[k] + at.turned[r] * shapes.slope[k];
                bottom[k] += at.own_force[r] * gradient[k] + at.turned[r] * shapes.slope[k];
            }
        }
        let [corner, corner_damped] = &mut self.corner;
        for (k, row) in corner[..self.border].iter_mut().enumerate() {
            for (entry, force_by) in row.iter_mut().zip(&force_by) {
                *entry += gradient[k] * force_by;
            }
        }
        corner[0][0] += at.beam;
        for k in 1..self.border {
            let bend = at.turned_by_beam * shapes.slope[k];
            corner[0][k] += bend;
            corner[k][0] += bend;
        }
        if BOTH {
            for r in 0..R {
                let by = c * at.own[r];
                for (sum, gradient) in damped.right[r].iter_mut().zip(&gradient) {
                    *sum += by * gradient;
                }
            }
            for (row, by) in corner_damped[..self.border].iter_mut().zip(&gradient) {
                for (sum, gradient) in row.iter_mut().zip(&gradient) {
                    *sum += c * by * gradient;
                }
            }
        }
    }
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
impl Terms<Each> {
    /// Returns the terms of one lane.
    #[inline(always)]
    fn lane(&self, lane: usize) -> Terms<f64> {
        let four = |of: &[Each; OWN]| of.each_ref().map(|each| each[lane]);
        Terms {
            own: four(&self.own),
            own_force: four(&self.own_force),
            turned: four(&self.turned),
            mixed: four(&self.mixed),
            by_beam: self.by_beam[lane],
            force_by_beam: self.force_by_beam[lane],
            beam: self.beam[lane],
            turned_by_beam: self.turned_by_beam[lane],
            stiffness: self.stiffness[lane],
            by_slope: self.by_slope[lane],
            damping: self.damping[lane],
        }
    }
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
impl<S: Simd> Terms<Vector<S>> {
    /// Stores the terms in the `k`-th vector of lanes.
    #[inline(always)]
    fn store(self, to: &mut Terms<Each>, k: usize) {
        let fours = [
            (&mut to.own, self.own),
            (&mut to.own_force, self.own_force),
            (&mut to.turned, self.turned),
            (&mut to.mixed, self.mixed),
        ];
        for (to, from) in fours {
            for (to, from) in to.iter_mut().zip(from) {
                write(to, k, from);
            }
        }
        let ones = [
            (&mut to.by_beam, self.by_beam),
            (&mut to.force_by_beam, self.force_by_beam),
            (&mut to.beam, self.beam),
            (&mut to.turned_by_beam, self.turned_by_beam),
            (&mut to.stiffness, self.stiffness),
            (&mut to.by_slope, self.by_slope),
            (&mut to.damping, self.damping),
        ];
        for (to, from) in ones {
            write(to, k, from);
        }
    }
}

/// Reads two quantities of the `k`-th vector of lanes.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn read_pair<S: Simd>(simd: S, [x, y]: &[Each; 2], k: usize) -> [Vector<S>; 2] {
    [read(simd, x, k), read(simd, y, k)]
}

/// Adds a contact point's tangent to its cylinder's own block, of `R` coordinates.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_own<T: Real, const R: usize>(
    point: &PointTangent<T>,
    at: &Terms<T>,
    sums: &mut [[T; OWN]; OWN],
) {
    for r in 0..R {
        for c in 0..R {
            let mut sum = sums[r][c] + (at.own[r] * at.own_force[c] + point.straight[r][c]);
            if r > 1 && c > 1 {
                sum = sum + point.bent[r][c];
            }
            sums[r][c] = sum;
        }
    }
}

/// Adds a contact point's rate-dependent tangent `gamma c G G^T` to its cylinder's own block.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_own_damping<T: Real, const R: usize>(at: &Terms<T>, sums: &mut [[T; OWN]; OWN]) {
    for r in 0..R {
        let by = at.damping * at.own[r];
        for c in 0..R {
            sums[r][c] = sums[r][c] + by * at.own[c];
        }
    }
}
