//! Contact points of a chain with its arc, stored as one array per quantity (structure of arrays), so that
//! compilers vectorise the arithmetic over many points. The geometry of contact and its law are evaluated
//! only here; forces, tangent and energy read the results.
use super::parts::Chain;
use crate::element::impact::{DerivativeVariable, Impact, ImpactForce};
use crate::math::spline::{SplinePosition, sum::KnotForces};
use crate::model::contact::{Curvature, POINTS, Surface, small_angle};
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// One value per contact point of a cylinder.
type Each = [f64; POINTS];

/// Contact points of the cylinders that may touch the arc, in one evaluation; buffers are allocated once.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Indices of the cylinders that may touch the arc, in ascending order.
    cylinders: Vec<usize>,
    /// Position of each point along its cylinder's axis, from the centre \[m\]; the field `share` holds its
    /// share of the contact coefficients.
    along: Each,
    share: Each,
    /// Position of each cylinder's centre relative to the arc's centre \[m\]; the field `place` holds that of
    /// each contact point.
    toward: [Vec<Each>; 2],
    place: [Vec<Each>; 2],
    /// Velocities of the contact points [m/s].
    velocity: [Vec<Each>; 2],
    /// Arc angle of each cylinder's centre in the beam frame \[rad\]; the field `angle` holds that of each
    /// contact point. Both are 0 for a circular surface.
    bearing: Vec<Each>,
    angle: Vec<Each>,
    /// Positions of the contact points on the grid of the arc's mode shapes; meaningless without modes.
    on_grid: Vec<[SplinePosition; POINTS]>,
    /// Height of the arc's deformed surface above the undeformed circle at each contact point \[m\]; `slope`
    /// is its derivative with respect to the arc angle [m/rad], `rising` its rate [m/s].
    height: Vec<Each>,
    slope: Vec<Each>,
    rising: Vec<Each>,
    /// Penetration of each contact point \[m\]; the field `rate` holds its rate [m/s].
    depth: Vec<Each>,
    rate: Vec<Each>,
    /// Derivatives of the penetration with respect to the contact point's position; the field `by_beam` holds
    /// those with respect to the beam angle.
    by_point: [Vec<Each>; 2],
    by_beam: Vec<Each>,
    /// Normal contact force at each point, never negative \[N\]; the field `lost` holds the power dissipated
    /// by the damping \[W\].
    force: Vec<Each>,
    lost: Vec<Each>,
}

/// Contact load of one cylinder, summed over its contact points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CylinderContact {
    /// Sum of the normal contact forces \[N\].
    pub(super) total: f64,
    /// Contact force on the cylinder as a vector \[N\]; the field `bend` holds its first moment along the
    /// cylinder's axis [N m].
    pub(super) push: V2,
    pub(super) bend: V2,
    /// Moment of the contact forces on the beam [N m].
    pub(super) beam: f64,
    /// Power dissipated by the contact damping \[W\].
    pub(super) lost: f64,
}

/// Loaded contact point with the quantities that a tangent needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPoint {
    /// Position of the point along the cylinder's axis, from the centre \[m\]; the field `velocity` holds the
    /// point's velocity [m/s].
    pub(super) along: f64,
    pub(super) velocity: V2,
    /// Arc angle of the point in the beam frame \[rad\]; 0 for a circular surface.
    pub(super) angle: f64,
    /// First derivatives of the penetration with respect to the point's position; the field `by_beam` holds
    /// that with respect to the beam angle, `curvature` the second derivatives.
    pub(super) by_point: V2,
    pub(super) by_beam: f64,
    pub(super) curvature: Curvature,
    /// Position of the point on the grid of the arc's mode shapes; meaningless without modes.
    pub(super) on_grid: SplinePosition,
    /// Contact force with its derivatives, multiplied by the point's share of the contact coefficients.
    pub(super) law: ImpactForce,
}

impl Points {
    /// Allocates the contact points of a chain.
    pub(super) fn new(chain: &Chain) -> Self {
        let zeros = || vec![[0.0; POINTS]; chain.count];
        let half = 0.5 * chain.pitch;
        Self {
            cylinders: Vec::with_capacity(chain.count),
            along: chain.contact_points.map(|(place, _)| place * half),
            share: chain.contact_points.map(|(_, share)| share),
            toward: [zeros(), zeros()],
            place: [zeros(), zeros()],
            velocity: [zeros(), zeros()],
            bearing: zeros(),
            angle: zeros(),
            on_grid: vec![[SplinePosition::default(); POINTS]; chain.count],
            height: zeros(),
            slope: zeros(),
            rising: zeros(),
            depth: zeros(),
            rate: zeros(),
            by_point: [zeros(), zeros()],
            by_beam: zeros(),
            force: zeros(),
            lost: zeros(),
        }
    }

    /// Returns the indices of the cylinders that may touch the arc, in ascending order.
    pub(super) fn cylinders(&self) -> &[usize] {
        &self.cylinders
    }

    /// Collects the contact points of all cylinders that may touch the arc, and evaluates the contact law
    /// there.
    pub(super) fn evaluate<'a, const A: usize, P: InPlane<A> + 'a>(
        &mut self,
        chain: &Chain,
        surface: &Surface<'_>,
        law: &Impact,
        poses: impl Iterator<Item = &'a P>,
    ) {
        self.collect(chain, surface, poses);
        if surface.is_noncircular() {
            self.compute_angles();
        }
        self.compute_heights(surface);
        self.compute_penetrations(surface);
        let n = self.cylinders.len();
        let (depth, rate) = (&self.depth[..n], &self.rate[..n]);
        let (force, lost) = (&mut self.force[..n], &mut self.lost[..n]);
        law.forces_batch(
            [depth.as_flattened(), rate.as_flattened()],
            [force.as_flattened_mut(), lost.as_flattened_mut()],
        );
    }

    /// Replaces the contact forces of all points by their derivatives with respect to the coefficient `by` of
    /// the contact law.
    pub(crate) fn replace_forces_by_derivatives(&mut self, law: &Impact, by: DerivativeVariable) {
        let n = self.cylinders.len();
        let force = self.force[..n].as_flattened_mut();
        let at = self.depth[..n].as_flattened().iter();
        for (force, (&depth, &rate)) in force.iter_mut().zip(at.zip(self.rate[..n].as_flattened()))
        {
            *force = law.derivative(depth, rate, by);
        }
    }

    fn collect<'a, const A: usize, P: InPlane<A> + 'a>(
        &mut self,
        chain: &Chain,
        surface: &Surface<'_>,
        poses: impl Iterator<Item = &'a P>,
    ) {
        let half = 0.5 * chain.pitch;
        self.cylinders.clear();
        let mut before = None;
        for (j, pose) in poses.enumerate() {
            let center = pose.center();
            let Some(bearing) = surface.bearing(before.as_ref(), &center, half) else {
                continue;
            };
            let c = self.cylinders.len();
            self.cylinders.push(j);
            let (velocity, axis, sweep) = (pose.velocity(), pose.axis(), pose.sweep());
            let toward = bearing.toward();
            for k in 0..2 {
                self.place[k][c] = self.along.map(|along| toward[k] + axis[k] * along);
                self.velocity[k][c] = self.along.map(|along| velocity[k] + sweep[k] * along);
                self.toward[k][c] = [toward[k]; POINTS];
            }
            self.bearing[c] = [bearing.angle(); POINTS];
            before = Some(bearing);
        }
    }

    /// Computes the arc angles of the contact points.
    fn compute_angles(&mut self) {
        let c = self.cylinders.len();
        let [ax, ay] = self.toward.each_ref().map(|x| x[..c].as_flattened());
        let [bx, by] = self.place.each_ref().map(|x| x[..c].as_flattened());
        let bearing = self.bearing[..c].as_flattened();
        let angle = self.angle[..c].as_flattened_mut();
        for i in 0..bearing.len() {
            let turned = small_angle([ax[i], ay[i]], [bx[i], by[i]]);
            angle[i] = bearing[i] + turned;
        }
    }

    /// Computes, at all contact points, height, slope and rate of the arc's deformed surface relative to the
    /// undeformed circle.
    fn compute_heights(&mut self, surface: &Surface<'_>) {
        let c = self.cylinders.len();
        let height = self.height[..c].as_flattened_mut();
        let slope = self.slope[..c].as_flattened_mut();
        let rising = self.rising[..c].as_flattened_mut();
        let angle = self.angle[..c].as_flattened();
        if let Some(bend) = &surface.bend {
            let on_grid = self.on_grid[..c].as_flattened_mut();
            for (place, &angle) in on_grid.iter_mut().zip(angle) {
                *place = bend.shapes.place(angle);
            }
            bend.sum
                .evaluate_all(bend.shapes, on_grid, [&mut *height, &mut *slope, rising]);
        } else {
            height.fill(0.0);
            slope.fill(0.0);
            rising.fill(0.0);
        }
        if let Some(profile) = surface.profile {
            for ((height, slope), &angle) in height.iter_mut().zip(slope).zip(angle) {
                let [raised, tilted, _] = profile.height(angle);
                *height += raised;
                *slope += tilted;
            }
        }
    }

    /// Computes the penetrations of all contact points, with their rates and derivatives.
    fn compute_penetrations(&mut self, surface: &Surface<'_>) {
        let c = self.cylinders.len();
        let n = c * POINTS;
        let [x, y] = self.place.each_ref().map(|x| &x[..c].as_flattened()[..n]);
        let [vx, vy] = self
            .velocity
            .each_ref()
            .map(|v| &v[..c].as_flattened()[..n]);
        let height = &self.height[..c].as_flattened()[..n];
        let slope = &self.slope[..c].as_flattened()[..n];
        let rising = &self.rising[..c].as_flattened()[..n];
        let [by_x, by_y] = self.by_point.each_mut();
        let by_x = &mut by_x[..c].as_flattened_mut()[..n];
        let by_y = &mut by_y[..c].as_flattened_mut()[..n];
        let depth = &mut self.depth[..c].as_flattened_mut()[..n];
        let rate = &mut self.rate[..c].as_flattened_mut()[..n];
        let by_beam = &mut self.by_beam[..c].as_flattened_mut()[..n];
        let (cx, cy) = (surface.center_by_beam.x, surface.center_by_beam.y);
        let (radius, turning) = (surface.radius, surface.beam[1]);
        let reach = surface.reach * surface.reach;
        for i in 0..n {
            let square = x[i] * x[i] + y[i] * y[i];
            let distance = square.sqrt();
            let inverse = 1.0 / distance;
            let (nx, ny) = (x[i] * inverse, y[i] * inverse);
            let tilt = slope[i] * inverse;
            let (bx, by) = (-ny * tilt - nx, nx * tilt - ny);
            let beam = -(bx * cx + by * cy) - slope[i];
            let inside = radius + height[i] - distance;
            by_x[i] = bx;
            by_y[i] = by;
            by_beam[i] = beam;
            rate[i] = rising[i] + (bx * vx[i] + by * vy[i]) + beam * turning;
            depth[i] = if square < reach { inside } else { -1.0 };
        }
    }

    /// Sums up the contact forces on the `k`-th cylinder of [`Self::cylinders`].
    #[inline]
    pub(super) fn cylinder_contact(&self, k: usize) -> CylinderContact {
        let (force, lost) = (&self.force[k], &self.lost[k]);
        let [x, y] = [&self.by_point[0][k], &self.by_point[1][k]];
        let beam = &self.by_beam[k];
        let mut sum = CylinderContact::default();
        for i in 0..POINTS {
            let force = self.share[i] * force[i];
            let push = V2::new(-force * x[i], -force * y[i]);
            sum.total += force;
            sum.push += push;
            sum.bend += push * self.along[i];
            sum.beam += force * beam[i];
            sum.lost += self.share[i] * lost[i];
        }
        sum
    }

    /// Iterates over the contact points under load on the `k`-th cylinder of [`Self::cylinders`].
    pub(super) fn loaded_points(&self, k: usize) -> impl Iterator<Item = usize> {
        let pressed = move |&i: &usize| self.share[i] * self.force[k][i] != 0.0;
        (0..POINTS).filter(pressed)
    }

    /// Returns contact point `i` of the `k`-th of [`Self::cylinders`]; surface and law must be those of the
    /// last evaluation.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn contact_point(
        &self,
        (k, i): (usize, usize),
        surface: &Surface<'_>,
        law: &Impact,
    ) -> ContactPoint {
        let law = law.force(self.depth[k][i], self.rate[k][i]);
        ContactPoint {
            along: self.along[i],
            velocity: V2::new(self.velocity[0][k][i], self.velocity[1][k][i]),
            angle: self.angle[k][i],
            by_point: V2::new(self.by_point[0][k][i], self.by_point[1][k][i]),
            by_beam: self.by_beam[k][i],
            curvature: self.curvature(k, i, surface),
            on_grid: self.on_grid[k][i],
            law: law.share(self.share[i]),
        }
    }

    /// Returns the derivatives of the contact force at point `i` of the `k`-th of [`Self::cylinders`] with
    /// respect to stiffness and damping of the law.
    pub(super) fn by_law(&self, (k, i): (usize, usize), law: &Impact) -> [f64; 2] {
        let by = law.force_by(self.depth[k][i], self.rate[k][i]);
        by.map(|by| self.share[i] * by)
    }

    /// Returns the second derivatives of the penetration of point `i` on the `k`-th cylinder of
    /// [`Self::cylinders`].
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    fn curvature(&self, k: usize, i: usize, surface: &Surface<'_>) -> Curvature {
        let toward = V2::new(self.place[0][k][i], self.place[1][k][i]);
        let (angle, slope) = (self.angle[k][i], self.slope[k][i]);
        surface.curvature(&toward, angle, &self.on_grid[k][i], slope)
    }

    /// Adds the elastic energy of the contact at all points to `sum` \[J\].
    pub(super) fn add_energy(&self, sum: &mut f64, law: &Impact) {
        for depths in &self.depth[..self.cylinders.len()] {
            for (share, &depth) in self.share.iter().zip(depths) {
                *sum += share * law.energy(depth);
            }
        }
    }

    /// Returns the largest penetration among all contact points \[m\], at least 0.
    pub(super) fn deepest(&self) -> f64 {
        let depths = self.depth[..self.cylinders.len()].as_flattened();
        let deeper = |deepest: f64, &depth: &f64| if depth > deepest { depth } else { deepest };
        depths.iter().fold(0.0, deeper)
    }

    /// Distributes the contact forces to the knots (grid points) of the arc's mode shapes, into `pressure`.
    pub(super) fn distribute_to_knots(&self, pressure: &mut KnotForces) {
        for (k, places) in self.on_grid[..self.cylinders.len()].iter().enumerate() {
            for (i, place) in places.iter().enumerate() {
                let force = self.share[i] * self.force[k][i];
                if force != 0.0 {
                    pressure.add(place, force);
                }
            }
        }
    }

    /// Iterates over pairs of arc angle \[rad\] and contact force \[N\] of all contact points.
    pub(crate) fn forces(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let points = self.angle.iter().zip(&self.force);
        let each = points.take(self.cylinders.len());
        each.flat_map(|(angle, force)| {
            std::array::from_fn::<_, POINTS, _>(|i| (angle[i], self.share[i] * force[i]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::sin_cos;
    use crate::math::spline::{Splines, sum::WeightedSplines};
    use crate::model::contact::Deflection;
    use crate::model::description::Arc;
    use crate::model::extension::profile::{Hollow, Profile};
    use crate::model::pose::PlanePose;

    /// Contact point in a test, with all its derivatives.
    struct Seen {
        depth: f64,
        rate: f64,
        angle: f64,
        by_point: V2,
        by_beam: f64,
        curvature: Curvature,
    }

    /// Coordinates of the test configuration: cylinder centre (x, y) and angle, beam angle, modal
    /// coordinates; `MOTION` holds their rates.
    const PLACE: [f64; 6] = [-1.9, -0.4, 1.3, 0.2, 0.3, -0.2];
    const MOTION: [f64; 6] = [0.4, -0.9, 0.8, 0.6, 0.5, 0.7];

    #[test]
    fn derivatives_match_differences() {
        let arc = Arc {
            center: [-0.15, -0.58],
            radius: 1.9,
            anchor: 2.2,
            sense: -1.0,
        };
        let shapes = Splines::natural(
            2.0,
            0.1,
            &[
                (0..20).map(|i| 0.02 * f64::from(i * i % 7)).collect(),
                (0..20)
                    .map(|i| 0.03 * f64::from(i * 3 % 5) - 0.05)
                    .collect(),
            ],
        );
        let mut profile = Profile::default();
        profile.add_profile_change(Hollow {
            depth: 0.01,
            centre: 2.8,
            reach: 0.2,
        });
        let law = Impact {
            stiffness: 4e8,
            exponent: 1.5,
            damping: 1e3,
            full_damping_penetration: 1e-4,
        };
        let chain = Chain::solid(0, 1, 0.01, 0.1, 7850.0);
        for (bent, worn) in [(false, false), (true, false), (false, true), (true, true)] {
            let at = |i: usize, x: [f64; 6]| {
                let mut sum = WeightedSplines::default();
                sum.assemble(&shapes, &x[4..], &MOTION[4..]);
                let bend = Deflection {
                    shapes: &shapes,
                    sum: &sum,
                    modal_rate: &MOTION[4..],
                };
                let mut surface = Surface::new(&arc, [x[3], MOTION[3]], bent.then_some(bend));
                surface.profile = worn.then_some(&profile);
                let (s, c) = sin_cos(x[2]);
                let pose = PlanePose::new(&x, &MOTION, V2::new(c, s));
                let mut points = Points::new(&chain);
                points.evaluate(&chain, &surface, &law, std::iter::once(&pose));
                assert_eq!(points.cylinders(), [0]);
                assert!(points.depth[0][i] > -0.5, "beyond the surface's reach");
                Seen {
                    depth: points.depth[0][i],
                    rate: points.rate[0][i],
                    angle: points.angle[0][i],
                    by_point: V2::new(points.by_point[0][0][i], points.by_point[1][0][i]),
                    by_beam: points.by_beam[0][i],
                    curvature: points.curvature(0, i, &surface),
                }
            };
            for i in 0..POINTS {
                assert_derivatives(&|x| at(i, x), bent || worn);
            }
        }
    }

    fn assert_derivatives(at: &dyn Fn([f64; 6]) -> Seen, turns: bool) {
        let h = 1e-6;
        let touch = at(PLACE);
        let curvature = touch.curvature;
        let along = |direction: [f64; 6]| {
            let step = |h: f64| at(std::array::from_fn(|k| PLACE[k] + h * direction[k]));
            let (plus, minus) = (step(h), step(-h));
            Seen {
                depth: (plus.depth - minus.depth) / (2.0 * h),
                rate: (plus.rate - minus.rate) / (2.0 * h),
                angle: (plus.angle - minus.angle) / (2.0 * h),
                by_point: (plus.by_point - minus.by_point) / (2.0 * h),
                by_beam: (plus.by_beam - minus.by_beam) / (2.0 * h),
                curvature,
            }
        };
        for (k, coordinate) in [0, 1, 3].into_iter().enumerate() {
            let mut direction = [0.0; 6];
            direction[coordinate] = 1.0;
            let by = along(direction);
            let (angle_by_point, angle_by_beam) = curvature.angle_by;
            if k < 2 {
                assert!((by.depth - touch.by_point[k]).abs() < 1e-8);
                assert!(
                    (by.by_point - curvature.point.column(k)).norm() < 1e-7,
                    "{k} {} {}",
                    by.by_point,
                    curvature.point
                );
                assert!((by.by_beam - curvature.mixed[k]).abs() < 1e-7);
                assert!(!turns || (by.angle - angle_by_point[k]).abs() < 1e-8);
            } else {
                assert!((by.depth - touch.by_beam).abs() < 1e-8);
                assert!(
                    (by.by_point - curvature.mixed).norm() < 1e-7,
                    "{} {}",
                    by.by_point,
                    curvature.mixed
                );
                assert!(
                    (by.by_beam - curvature.beam).abs() < 1e-7,
                    "{} {}",
                    by.by_beam,
                    curvature.beam
                );
                assert!(!turns || (by.angle - angle_by_beam).abs() < 1e-8);
            }
        }
        let moving = along(MOTION);
        assert!((moving.depth - touch.rate).abs() < 1e-8, "{}", touch.rate);
    }
}
