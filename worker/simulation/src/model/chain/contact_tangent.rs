//! Tangent of a chain's contact with an arc.
//!
//! For the force `Q = -f grad d` of one Gauss point, `-dQ = grad d (df)^T + f H dq` with
//! `df = (f_d + gamma c) grad d + c H q'`: `f_d` and `c` are the law's derivatives by penetration
//! and rate, `H` the second derivatives of the penetration.
//!
//! Seen from a point, the coordinates are those of its cylinder that move it (`x`, `y` and the
//! angles that turn the axis), then those of the border. With the derivatives `G` of the penetration
//! and `F` of the force by all of them, a point adds `G F^T` and the force times what bends.
use super::parts::Chain;
use super::points::{Points, Touch};
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::contact::Surface;
use crate::model::layout::{MAX_MODES, Motion};
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Coordinates that move a point of a cylinder: two, and one or two angles.
const OWN: usize = 4;
/// Most coordinates of the border: the beam angle, then the modes.
const BORDER: usize = MAX_MODES + 1;
/// Those of a usual head, whose sums are short enough to be unrolled.
const FEW: usize = 8;

/// One chain's contact while its tangent is added up; there is room for `B` coordinates of the border.
struct Tangent<'a, const B: usize> {
    chain: &'a Chain,
    surface: &'a Surface<'a>,
    law: &'a Impact,
    gamma: f64,
    /// Coordinates of the border that take part.
    border: usize,
    corner: [[f64; B]; B],
}

/// What the points of one cylinder add.
struct Sums<const B: usize> {
    own: [[f64; OWN]; OWN],
    /// Rows of the cylinder, columns of the border.
    right: [[f64; B]; OWN],
    /// Rows of the border, columns of the cylinder, transposed.
    bottom: [[f64; B]; OWN],
}

/// A point's derivatives.
struct Derivatives<const B: usize> {
    /// Of the penetration and of the force by the cylinder's coordinates.
    own: [f64; OWN],
    own_force: [f64; OWN],
    /// How those move the point.
    moved: [V2; OWN],
    /// Of the penetration and of the force by the border's coordinates.
    gradient: [f64; B],
    force_by: [f64; B],
    /// Slopes of the modes' shapes over the arc; the beam angle has none.
    slope: [f64; B],
}

/// A pressed point as a reading asks for it, of a cylinder that moves in the plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached {
    /// Force \[N\] and arc angle \[rad\].
    pub(crate) force: f64,
    pub(crate) angle: f64,
    /// Derivatives of the force by stiffness and by damping of the law.
    pub(crate) by_law: [f64; 2],
    /// Derivatives of the force by the cylinder's coordinates and by their rates, and of the angle.
    pub(crate) force_by: [[f64; 3]; 2],
    pub(crate) angle_by: [f64; 3],
    /// The same by the beam angle, then by the modes, which turn no angle.
    pub(crate) force_by_border: [[f64; BORDER]; 2],
    pub(crate) angle_by_beam: f64,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Gives every pressed point of cylinders that move in the plane, and its cylinder.
    pub(crate) fn each_reached(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        mut visit: impl FnMut(usize, &Reached),
    ) {
        let tangent = Tangent::<BORDER> {
            chain: self,
            surface,
            law,
            gamma: 0.0,
            border: surface.modes() + 1,
            corner: [[0.0; BORDER]; BORDER],
        };
        let points = &state.points;
        for (k, &j) in points.cylinders().iter().enumerate() {
            for touch in points.touches(k, surface, law) {
                let point = tangent.derivatives(&state.plane[j], &touch);
                let (angle_by_point, angle_by_beam) = touch.curvature.angle_by;
                let own = |of: &dyn Fn(usize) -> f64| std::array::from_fn(of);
                let by_rate = touch.law.by_rate;
                let reached = Reached {
                    force: touch.law.force,
                    angle: touch.angle,
                    by_law: touch.by_law,
                    force_by: [
                        own(&|r| point.own_force[r]),
                        own(&|r| by_rate * point.own[r]),
                    ],
                    angle_by: own(&|r| angle_by_point.dot(&point.moved[r])),
                    force_by_border: [point.force_by, point.gradient.map(|x| by_rate * x)],
                    angle_by_beam,
                };
                visit(j, &reached);
            }
        }
    }

    /// Adds the contact's tangent to the cylinders' blocks and to the border, if there is one.
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
        if border <= FEW {
            self.add_tangent_within::<FEW>(on, state, gamma, (matrix, border));
        } else {
            self.add_tangent_within::<BORDER>(on, state, gamma, (matrix, border));
        }
    }

    /// The same to two matrices at once, to the first without damping.
    pub(crate) fn add_contact_tangents(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        matrices: [&mut Bordered; 2],
    ) {
        let border = matrices[0].border().min(surface.modes() + 1);
        let on = (surface, law);
        if border <= FEW {
            self.add_tangents_within::<FEW>(on, state, gamma, (matrices, border));
        } else {
            self.add_tangents_within::<BORDER>(on, state, gamma, (matrices, border));
        }
    }

    fn add_tangents_within<const B: usize>(
        &self,
        (surface, law): (&Surface<'_>, &Impact),
        state: &ChainState,
        gamma: f64,
        (matrices, border): ([&mut Bordered; 2], usize),
    ) {
        let mut pair = [0.0, gamma].map(|gamma| Tangent::<B> {
            chain: self,
            surface,
            law,
            gamma,
            border,
            corner: [[0.0; B]; B],
        });
        match self.motion {
            Motion::Plane => add_both(&mut pair, &state.points, &state.plane, matrices),
            Motion::Space => add_both(&mut pair, &state.points, &state.poses, matrices),
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

/// Adds the tangents of two factors of the damping, the first of which is zero.
fn add_both<const A: usize, const B: usize>(
    pair: &mut [Tangent<'_, B>; 2],
    points: &Points,
    poses: &[impl InPlane<A>],
    mut matrices: [&mut Bordered; 2],
) {
    for (k, &j) in points.cylinders().iter().enumerate() {
        let mut sums = [Sums::<B>::zero(), Sums::zero()];
        let mut touched = false;
        for touch in points.touches(k, pair[0].surface, pair[0].law) {
            touched = true;
            let mut point = pair[0].derivatives(&poses[j], &touch);
            for (tangent, sums) in pair.iter_mut().zip(&mut sums) {
                let damped = tangent.gamma * touch.law.by_rate;
                for (by, own) in point.own_force.iter_mut().zip(point.own) {
                    *by += damped * own;
                }
                for (by, own) in point.force_by.iter_mut().zip(point.gradient) {
                    *by += damped * own;
                }
                tangent.add_point(&point, &touch, &poses[j], sums);
            }
        }
        let each = pair.iter().zip(&sums).zip(&mut matrices);
        for ((tangent, sums), matrix) in each.filter(|_| touched) {
            tangent.add_sums::<A>(tangent.chain.first + j, sums, matrix);
        }
    }
    for (tangent, matrix) in pair.iter().zip(matrices) {
        tangent.add_corner(matrix);
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
}

impl<const B: usize> Tangent<'_, B> {
    fn add_cylinders<const A: usize>(
        &mut self,
        points: &Points,
        poses: &[impl InPlane<A>],
        matrix: &mut Bordered,
    ) {
        for (k, &j) in points.cylinders().iter().enumerate() {
            let mut touches = points.touches(k, self.surface, self.law).peekable();
            if touches.peek().is_none() {
                continue;
            }
            let mut sums = Sums::zero();
            for touch in touches {
                let point = self.derivatives(&poses[j], &touch);
                self.add_point(&point, &touch, &poses[j], &mut sums);
            }
            self.add_sums::<A>(self.chain.first + j, &sums, matrix);
        }
    }

    fn add_corner(&self, matrix: &mut Bordered) {
        for row in 0..self.border {
            for column in 0..self.border {
                matrix.add_corner(row, column, self.corner[row][column]);
            }
        }
    }

    /// Adds what the points of one cylinder add to its block and to the border.
    fn add_sums<const A: usize>(&self, block: usize, sums: &Sums<B>, matrix: &mut Bordered) {
        let rows: [usize; OWN] = std::array::from_fn(|k| {
            if k < 2 {
                k
            } else {
                self.chain.motion.width() - A + k - 2
            }
        });
        for r in 0..2 + A {
            for c in 0..2 + A {
                matrix.add_diagonal(block, rows[r], rows[c], sums.own[r][c]);
            }
            let of = ..self.border;
            matrix.add_border(block, rows[r], &sums.right[r][of], &sums.bottom[r][of]);
        }
    }

    /// Adds what one point adds.
    fn add_point<const A: usize>(
        &mut self,
        point: &Derivatives<B>,
        touch: &Touch,
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

    /// Derivatives of penetration and force by all coordinates.
    fn derivatives<const A: usize>(&self, pose: &impl InPlane<A>, touch: &Touch) -> Derivatives<B> {
        let surface = self.surface;
        let Touch {
            along,
            velocity,
            curvature,
            law: at,
            ..
        } = touch;
        let stiff = at.by_penetration + self.gamma * at.by_rate;
        let (angle_by_point, angle_by_beam) = curvature.angle_by;
        let beam_rate = surface.beam[1];
        let angle_rate = angle_by_point.dot(velocity) + angle_by_beam * beam_rate;
        let mut gradient = [0.0; B];
        let mut force_by = [0.0; B];
        let mut slope = [0.0; B];
        let mut drift = 0.0;
        if let Some(bend) = &surface.bend {
            let modes = 1..self.border;
            let (values, slopes) = (&mut gradient[modes.clone()], &mut slope[modes.clone()]);
            bend.shapes.slopes(&touch.on_grid, values, slopes);
            for (k, rate) in modes.clone().zip(bend.modal_rate) {
                drift += rate * slope[k];
            }
            for k in modes {
                force_by[k] = gradient[k] * stiff + slope[k] * (angle_rate * at.by_rate);
            }
        }
        // rates of the gradient along the motion: H q'
        let point_rate =
            curvature.point * velocity + curvature.mixed * beam_rate + angle_by_point * drift;
        let beam_gradient_rate =
            curvature.mixed.dot(velocity) + curvature.beam * beam_rate + angle_by_beam * drift;
        gradient[0] = touch.by_beam;
        force_by[0] = touch.by_beam * stiff + beam_gradient_rate * at.by_rate;

        let (arms, sweeps) = (pose.axis_by(), pose.sweep_by());
        let moved: [V2; OWN] = std::array::from_fn(|k| match k {
            0 => V2::x(),
            1 => V2::y(),
            k => arms.get(k - 2).map_or_else(V2::zeros, |arm| arm * *along),
        });
        let by_place = touch.by_point * stiff + point_rate * at.by_rate;
        Derivatives {
            own: moved.map(|moved| touch.by_point.dot(&moved)),
            own_force: std::array::from_fn(|k| {
                let turning = k.checked_sub(2).and_then(|a| sweeps.get(a));
                let turning = turning.map_or(0.0, |sweep| along * touch.by_point.dot(sweep));
                by_place.dot(&moved[k]) + at.by_rate * turning
            }),
            moved,
            gradient,
            force_by,
            slope,
        }
    }

    fn add_border<const A: usize>(
        &mut self,
        point: &Derivatives<B>,
        touch: &Touch,
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

/// Adds to a cylinder's own block, but for the bending of its axis.
fn add_own<const A: usize, const B: usize>(
    point: &Derivatives<B>,
    touch: &Touch,
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
