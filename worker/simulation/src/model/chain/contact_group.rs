//! Neighbouring cylinders of a chain near its arc, evaluated side by side in SIMD lanes: geometry and law at their
//! contact points, and the sums of the forces.
use crate::element::impact::{DerivativeVariable, Impact};
use crate::element::law::ForceLaw;
use crate::math::real::{Real as _, Vector, WIDEST};
use crate::math::spline::sum::{FORCE_MOMENTS, KNOTS, LocalCubic, force_moments};
use crate::model::contact::{POINTS, Surface, is_near, small_angle};
use crate::model::pose::{InPlane, PlanePoses, Pose};
use nalgebra::Vector2;
use pulp::Simd;

type V2 = Vector2<f64>;

/// One value for each of some neighbouring cylinders.
pub(super) type Each = [f64; WIDEST];

/// Neighbouring cylinders with their contact points, one per lane.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Group {
    /// Position of the cylinder's centre relative to the arc's centre \[m\], and velocity of that centre
    /// [m/s]; `axis` holds the direction of the cylinder's axis and `sweep` its time derivative [1/s].
    pub(super) toward: [Each; 2],
    pub(super) velocity: [Each; 2],
    pub(super) axis: [Each; 2],
    pub(super) sweep: [Each; 2],
    /// Position of the centre of the cylinder before; not a number for the first one.
    pub(super) before: [Each; 2],
    /// Arc angle of the cylinder's centre in the beam frame \[rad\]; 0 for a circular surface. Before it is
    /// known, the angle from the cylinder before, not a number where that is too far away.
    pub(super) bearing: Each,
    /// Left knot, on the grid of the arc's mode shapes, of the interval in which the cylinder's centre lies;
    /// the field `on_grid` holds the centre's distance from that knot in intervals, and `knots` the mode
    /// shapes' sums around it. Meaningless unless the height is `Height::Local`.
    pub(super) left: Each,
    pub(super) on_grid: Each,
    pub(super) knots: [Each; KNOTS],
    /// Arc angle of each contact point in the beam frame \[rad\]; 0 for a circular surface.
    pub(super) angle: [Each; POINTS],
    /// Distance of each contact point from the knot `left` in grid intervals; within the grid.
    pub(super) place: [Each; POINTS],
    /// Slope of the arc's deformed surface at each contact point: derivative of its height with respect to the
    /// arc angle [m/rad].
    pub(super) slope: [Each; POINTS],
    /// Penetration of each contact point \[m\]; the field `rate` holds its rate [m/s].
    pub(super) depth: [Each; POINTS],
    pub(super) rate: [Each; POINTS],
    /// Derivatives of the penetration with respect to the contact point's position, negative; the field
    /// `by_beam` holds those with respect to the beam angle.
    pub(super) outward: [[Each; 2]; POINTS],
    pub(super) by_beam: [Each; POINTS],
    /// Normal contact force at each point, never negative \[N\]; the field `lost` holds the power dissipated
    /// by the damping \[W\].
    pub(super) force: [Each; POINTS],
    pub(super) lost: [Each; POINTS],
    /// Sum of the contact forces on the cylinder \[N\], as numbers and as a vector; the field `bend` holds the
    /// first moment of the vectors along the cylinder's axis [N m].
    pub(super) total: Each,
    pub(super) push: [Each; 2],
    pub(super) bend: [Each; 2],
    /// Sums of the moment of the contact forces on the beam [N m] and of the power dissipated \[W\].
    pub(super) beam: Each,
    pub(super) loss: Each,
    /// Moments of the forces on the grid of the arc's mode shapes; meaningless unless the height is
    /// `Height::Local`.
    pub(super) moments: [Each; FORCE_MOMENTS],
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast saturates, and a position before the grid belongs to its first interval"
)]
pub(super) const fn index(place: f64) -> usize {
    place as usize
}

/// Returns the `k`-th vector of lanes of a group.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn read<S: Simd>(simd: S, each: &Each, k: usize) -> Vector<S> {
    Vector::new(simd, S::as_simd_f64s(each).0[k])
}

/// Stores the `k`-th vector of lanes of a group.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn write<S: Simd>(each: &mut Each, k: usize, vector: Vector<S>) {
    S::as_mut_simd_f64s(each).0[k] = vector.lanes();
}

/// Copies the motion of cylinders in the plane relative to the arc's centre, from cylinder `first` on.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn place_plane<S: Simd>(
    simd: S,
    groups: &mut [Group],
    surface: &Surface<'_>,
    poses: &PlanePoses,
    first: usize,
) {
    let vectors = WIDEST / S::F64_LANES;
    let rods = poses.rods(simd, first, groups.len() * vectors);
    for (g, group) in groups.iter_mut().enumerate() {
        for k in 0..vectors {
            let rod = rods.get(g * vectors + k);
            let center = [surface.center.x, surface.center.y];
            for d in 0..2 {
                write(&mut group.toward[d], k, rod.place[d] - center[d]);
                write(&mut group.velocity[d], k, rod.velocity[d]);
                write(&mut group.axis[d], k, rod.axis[d]);
            }
            write(&mut group.sweep[0], k, -(rod.axis[1] * rod.rate));
            write(&mut group.sweep[1], k, rod.axis[0] * rod.rate);
        }
    }
}

/// Copies the motion of cylinders in space relative to the arc's centre, projected onto the plane.
pub(super) fn place_space(groups: &mut [Group], surface: &Surface<'_>, poses: &[Pose]) {
    for (group, poses) in groups.iter_mut().zip(poses.chunks(WIDEST)) {
        for (lane, pose) in poses.iter().enumerate() {
            let toward = pose.center() - surface.center;
            let (velocity, axis, sweep) = (pose.velocity(), pose.axis(), pose.sweep());
            for d in 0..2 {
                group.toward[d][lane] = toward[d];
                group.velocity[d][lane] = velocity[d];
                group.axis[d][lane] = axis[d];
                group.sweep[d][lane] = sweep[d];
            }
        }
    }
}

/// Fills the lanes beyond the last of `n` cylinders with its motion, so that they compute with numbers too.
#[inline]
pub(super) fn repeat_last(groups: &mut [Group], n: usize) {
    let Some(group) = groups.last_mut() else {
        return;
    };
    let last = (n - 1) % WIDEST;
    let motion = [
        &mut group.toward,
        &mut group.velocity,
        &mut group.axis,
        &mut group.sweep,
    ];
    for each in motion.into_iter().flatten() {
        let value = each[last];
        each[last + 1..].fill(value);
    }
}

/// Finds the arc angle of each cylinder's centre, from that of the cylinder before where that is near, which
/// saves the arc tangent.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn find_bearings<S: Simd>(simd: S, groups: &mut [Group], surface: &Surface<'_>) {
    let mut last = [f64::NAN; 2];
    for group in &mut *groups {
        for d in 0..2 {
            let [a, b, c, end] = group.toward[d];
            group.before[d] = [last[d], a, b, c];
            last[d] = end;
        }
    }
    // in a loop of its own: a vector of numbers that were stored a moment ago one by one is slow to read
    for group in &mut *groups {
        for k in 0..WIDEST / S::F64_LANES {
            let from = group.before.each_ref().map(|each| read(simd, each, k));
            let to = group.toward.each_ref().map(|each| read(simd, each, k));
            let turned = is_near(from, to, small_angle(from, to));
            write(&mut group.bearing, k, turned);
        }
    }
    let mut bearing = 0.0;
    for group in groups {
        for lane in 0..WIDEST {
            let turned = group.bearing[lane];
            bearing = if turned.is_nan() {
                surface.arc_angle(&V2::new(group.toward[0][lane], group.toward[1][lane]))
            } else {
                bearing + turned
            };
            group.bearing[lane] = bearing;
        }
    }
}

/// Finds the grid interval of each cylinder's centre, and the sums of the mode shapes around it.
#[inline]
pub(super) fn find_on_grid(groups: &mut [Group], surface: &Surface<'_>) {
    let Some(bend) = &surface.bend else { return };
    let last = bend.shapes.last() - 1;
    for group in groups {
        for lane in 0..WIDEST {
            let at = bend.shapes.in_steps(group.bearing[lane]);
            let left = index(at).min(last);
            group.left[lane] = left as f64;
            group.on_grid[lane] = at - left as f64;
            for (each, value) in group.knots.iter_mut().zip(bend.sum.around(left)) {
                each[lane] = value;
            }
        }
    }
}

/// Values of the parameter `HEIGHT` of [`evaluate`].
pub(super) const CIRCULAR: u8 = 0;
pub(super) const LOCAL: u8 = 1;
pub(super) const AT_POINTS: u8 = 2;

/// Evaluates geometry and law at the contact points of all cylinders, and sums the forces.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn evaluate<S: Simd, const HEIGHT: u8>(
    simd: S,
    groups: &mut [Group],
    (surface, law): (&Surface<'_>, &Impact),
    [along, share]: [&[f64; POINTS]; 2],
) {
    let (zero, one) = (Vector::splat(simd, 0.0), Vector::splat(simd, 1.0));
    let turning = surface.beam[1];
    let (cx, cy) = (surface.center_by_beam.x, surface.center_by_beam.y);
    let reach = zero.constant(surface.reach * surface.reach);
    for group in groups {
        for k in 0..WIDEST / S::F64_LANES {
            let pair = |of: &[Each; 2]| of.each_ref().map(|each| read(simd, each, k));
            let ([wx, wy], [vx, vy]) = (pair(&group.toward), pair(&group.velocity));
            let ([ex, ey], [sx, sy]) = (pair(&group.axis), pair(&group.sweep));
            // each stage for all points of a cylinder: the points do not wait for each other
            let places = along.map(|along| [wx + ex * along, wy + ey * along]);
            let surfaces = group.find_heights::<S, HEIGHT>(simd, k, surface, (along, places));
            let distances = places.map(|[x, y]| {
                let square = x * x + y * y;
                [square, square.sqrt()]
            });
            let mut reached = [[zero; 2]; POINTS];
            for i in 0..POINTS {
                let ([x, y], [square, distance]) = (places[i], distances[i]);
                let [height, slope, rising] = surfaces[i];
                let inverse = one / distance;
                let (nx, ny) = (x * inverse, y * inverse);
                let tilt = slope * inverse;
                let (ox, oy) = (nx + ny * tilt, ny - nx * tilt);
                let beam = ox * cx + oy * cy - slope;
                let inside = height + surface.radius - distance;
                let (px, py) = (vx + sx * along[i], vy + sy * along[i]);
                let rate = rising - (ox * px + oy * py) + beam * turning;
                let depth = square.select_less(reach, inside, -one);
                write(&mut group.slope[i], k, slope);
                write(&mut group.depth[i], k, depth);
                write(&mut group.rate[i], k, rate);
                write(&mut group.outward[i][0], k, ox);
                write(&mut group.outward[i][1], k, oy);
                write(&mut group.by_beam[i], k, beam);
                reached[i] = [depth, rate];
            }
            let answers = reached.map(|[depth, rate]| law.response([depth], [rate]));
            for (i, answer) in answers.into_iter().enumerate() {
                write(&mut group.force[i], k, answer.force[0]);
                write(&mut group.lost[i], k, answer.dissipated);
            }
        }
        group.sum_forces(simd, [along, share], HEIGHT == LOCAL);
    }
}

impl Group {
    /// Finds the arc angles of contact points at the given positions from the arc's centre, and returns height,
    /// slope and rate of the arc's deformed surface there, relative to the undeformed circle.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn find_heights<S: Simd, const HEIGHT: u8>(
        &mut self,
        simd: S,
        k: usize,
        surface: &Surface<'_>,
        (along, places): (&[f64; POINTS], [[Vector<S>; 2]; POINTS]),
    ) -> [[Vector<S>; 3]; POINTS] {
        let zero = Vector::splat(simd, 0.0);
        let mut surfaces = [[zero; 3]; POINTS];
        if HEIGHT == CIRCULAR {
            for angle in &mut self.angle {
                write(angle, k, zero);
            }
            return surfaces;
        }
        let center = self.toward.each_ref().map(|each| read(simd, each, k));
        let bearing = read(simd, &self.bearing, k);
        let mut turned = [zero; POINTS];
        for (i, place) in places.into_iter().enumerate() {
            // a point in the centre of its cylinder does not turn
            if along[i] != 0.0 {
                turned[i] = small_angle(center, place);
            }
            write(&mut self.angle[i], k, bearing + turned[i]);
        }
        if let Some(bend) = &surface.bend {
            let shapes = bend.shapes;
            if HEIGHT == LOCAL {
                let (left, on_grid) = (read(simd, &self.left, k), read(simd, &self.on_grid, k));
                let sums = LocalCubic::new(self.knots.each_ref().map(|each| read(simd, each, k)));
                let (low, high) = (-left, -left + shapes.last() as f64);
                for i in 0..POINTS {
                    let place = on_grid + turned[i] * shapes.per_step();
                    let inside = place.at_least(low).at_most(high);
                    write(&mut self.place[i], k, inside);
                    let [height, slope, rising] = sums.at(inside);
                    // constant beyond the grid
                    let slope = place.select_less(low, zero, slope * shapes.per_step());
                    let slope = high.select_less(place, zero, slope);
                    surfaces[i] = [height, slope, rising];
                }
            } else {
                surfaces = turned.map(|turned| {
                    (bearing + turned).each(|angle| {
                        let (jet, rising) = bend.sum.at(shapes, &shapes.place(angle));
                        [jet.value, jet.first, rising]
                    })
                });
            }
        }
        if let Some(profile) = surface.profile {
            for (surface, turned) in surfaces.iter_mut().zip(turned) {
                let [raised, tilted, _] = (bearing + turned).each(|angle| profile.height(angle));
                surface[0] = surface[0] + raised;
                surface[1] = surface[1] + tilted;
            }
        }
        surfaces
    }

    /// Replaces the contact forces by their derivatives with respect to the coefficient `by` of the law.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(super) fn differentiate<S: Simd>(&mut self, simd: S, law: &Impact, by: DerivativeVariable) {
        for k in 0..WIDEST / S::F64_LANES {
            for i in 0..POINTS {
                let [depth, rate] = [&self.depth[i], &self.rate[i]].map(|each| read(simd, each, k));
                write(&mut self.force[i], k, law.derivative(depth, rate, by));
            }
        }
    }

    /// Sums the contact forces of each cylinder over its points and, where `local`, the moments of the forces
    /// on the grid of the mode shapes.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(super) fn sum_forces<S: Simd>(
        &mut self,
        simd: S,
        [along, share]: [&[f64; POINTS]; 2],
        local: bool,
    ) {
        let zero = Vector::splat(simd, 0.0);
        for k in 0..WIDEST / S::F64_LANES {
            let mut sums = [zero; 7];
            let mut moments = [zero; FORCE_MOMENTS];
            for i in 0..POINTS {
                let force = read(simd, &self.force[i], k) * share[i];
                let [x, y] = self.outward[i]
                    .each_ref()
                    .map(|outward| force * read(simd, outward, k));
                let own = [
                    force,
                    x,
                    y,
                    x * along[i],
                    y * along[i],
                    force * read(simd, &self.by_beam[i], k),
                    read(simd, &self.lost[i], k) * share[i],
                ];
                for (sum, own) in sums.iter_mut().zip(own) {
                    *sum = *sum + own;
                }
                if local {
                    let own = force_moments(read(simd, &self.place[i], k), force);
                    for (sum, own) in moments.iter_mut().zip(own) {
                        *sum = *sum + own;
                    }
                }
            }
            let [total, x, y, bend_x, bend_y, beam, loss] = sums;
            write(&mut self.total, k, total);
            write(&mut self.push[0], k, x);
            write(&mut self.push[1], k, y);
            write(&mut self.bend[0], k, bend_x);
            write(&mut self.bend[1], k, bend_y);
            write(&mut self.beam, k, beam);
            write(&mut self.loss, k, loss);
            if local {
                for (each, moment) in self.moments.iter_mut().zip(moments) {
                    write(each, k, moment);
                }
            }
        }
    }
}
