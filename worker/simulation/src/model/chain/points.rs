//! Contact points of a chain with its arc. The geometry of contact and its law are evaluated only here;
//! forces, tangent and energy read the results.
//!
//! Neighbouring cylinders are evaluated side by side in SIMD lanes; what belongs to [`WIDEST`] of them is stored
//! together (array of structures of arrays).
use super::contact_group::{
    AT_POINTS, CIRCULAR, Each, Group, LOCAL, evaluate, find_bearings, find_on_grid, index,
    place_plane, place_space, repeat_last,
};
use super::parts::Chain;
use crate::element::impact::{DerivativeVariable, Impact};
use crate::element::law::{ForceLaw, LawResponse};
use crate::math::real::WIDEST;
use crate::math::spline::Splines;
use crate::math::spline::sum::KnotForces;
use crate::model::contact::{POINTS, Surface};
use crate::model::pose::{InPlane, PlanePoses, Pose};
use nalgebra::Vector2;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

type V2 = Vector2<f64>;

/// Contact points of the cylinders that may touch the arc, in one evaluation; buffers are allocated once.
#[derive(Clone, Debug)]
pub struct Points {
    /// Cylinders from the first to the last that may touch the arc.
    touching: Range<usize>,
    /// Way in which the height of the surface was computed.
    height: Height,
    /// Position of each point along its cylinder's axis, from the centre \[m\]; the field `share` holds its
    /// share of the contact coefficients.
    along: [f64; POINTS],
    share: [f64; POINTS],
    /// The cylinders of `touching`, [`WIDEST`] of them each; lanes beyond the last cylinder have no meaning.
    groups: Vec<Group>,
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
    /// point's velocity [m/s], `toward` its position relative to the arc's centre \[m\].
    pub(super) along: f64,
    pub(super) velocity: [f64; 2],
    pub(super) toward: [f64; 2],
    /// Arc angle of the point in the beam frame \[rad\]; 0 for a circular surface. The field `slope` holds the
    /// derivative of the surface's height with respect to it [m/rad].
    pub(super) angle: f64,
    pub(super) slope: f64,
    /// First derivatives of the penetration with respect to the point's position; the field `by_beam` holds
    /// that with respect to the beam angle.
    pub(super) by_point: [f64; 2],
    pub(super) by_beam: f64,
    /// Answer of the contact law, multiplied by the point's share of the contact coefficients.
    pub(super) law: LawResponse<f64, 1>,
}

/// Way in which the height of the arc's surface above the undeformed circle is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Height {
    /// The surface is a circle.
    Circular,
    /// From the mode shapes around each cylinder's centre, and the profile.
    Local,
    /// From the mode shapes at each contact point, and the profile: on a grid finer than the cylinders, and
    /// without modes.
    AtPoints,
}

/// Poses of the cylinders of a chain, in the plane or in space.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cylinders<'a> {
    Plane(&'a PlanePoses),
    Space(&'a [Pose]),
}

impl Height {
    /// Chooses the way for a surface and for contact points of cylinders of half length `half`.
    fn of(surface: &Surface<'_>, half: f64) -> Self {
        let Some(bend) = &surface.bend else {
            return if surface.profile.is_some() {
                Self::AtPoints
            } else {
                Self::Circular
            };
        };
        // a contact point is less than half a cylinder away from the centre; deeper than a tenth of the radius
        // the rope is through the head, and its run ends
        let intervals = half / (0.9 * surface.radius) * bend.shapes.per_step();
        if intervals < 1.0 && bend.shapes.last() > 0 {
            Self::Local
        } else {
            Self::AtPoints
        }
    }
}

impl Cylinders<'_> {
    /// Returns the cylinders from the first to the last whose centre is less than `reach` away from `center`.
    fn within(&self, reach: f64, center: V2) -> Range<usize> {
        let poses = match self {
            Self::Plane(poses) => return poses.within(reach, center),
            Self::Space(poses) => poses,
        };
        let near = |pose: &Pose| (pose.center() - center).norm_squared() < reach * reach;
        let first = poses.iter().position(near).unwrap_or(0);
        let end = poses.iter().rposition(near).map_or(first, |last| last + 1);
        first..end
    }
}

impl Points {
    /// Allocates the contact points of a chain.
    pub(super) fn new(chain: &Chain) -> Self {
        let half = 0.5 * chain.pitch;
        Self {
            touching: 0..0,
            height: Height::Circular,
            along: chain.contact_points.map(|(place, _)| place * half),
            share: chain.contact_points.map(|(_, share)| share),
            groups: vec![Group::default(); chain.count.div_ceil(WIDEST)],
        }
    }

    /// Returns the cylinders from the first to the last that may touch the arc.
    pub(super) fn touching(&self) -> Range<usize> {
        self.touching.clone()
    }

    /// Evaluates the contact law at the contact points of all cylinders that may touch the arc.
    pub(super) fn evaluate(
        &mut self,
        chain: &Chain,
        surface: &Surface<'_>,
        law: &Impact,
        cylinders: Cylinders<'_>,
    ) {
        let half = 0.5 * chain.pitch;
        self.height = Height::of(surface, half);
        self.touching = cylinders.within(surface.reach + half, surface.center);
        Arch::new().dispatch(Evaluate {
            points: self,
            surface,
            law,
            cylinders,
        });
    }

    /// Returns the groups of the cylinders that may touch the arc.
    pub(super) fn groups(&self) -> &[Group] {
        &self.groups[..self.touching.len().div_ceil(WIDEST)]
    }

    /// Returns the position of contact point `i` along its cylinder's axis, from the centre \[m\], and its share of
    /// the contact coefficients.
    pub(super) const fn point(&self, i: usize) -> (f64, f64) {
        (self.along[i], self.share[i])
    }

    /// Returns the group of the `k`-th cylinder that may touch the arc, and its lane.
    #[inline]
    fn at(&self, k: usize) -> (&Group, usize) {
        (&self.groups[k / WIDEST], k % WIDEST)
    }

    /// Replaces the contact forces of all points by their derivatives with respect to the coefficient `by` of
    /// the contact law, and sums these as the forces are.
    pub(crate) fn replace_forces_by_derivatives(&mut self, law: &Impact, by: DerivativeVariable) {
        let groups = self.touching.len().div_ceil(WIDEST);
        Arch::new().dispatch(Differentiate {
            groups: &mut self.groups[..groups],
            law,
            by,
            points: [&self.along, &self.share],
            local: self.height == Height::Local,
        });
    }

    /// Adds the contact forces to the generalised forces of cylinders in the plane, three numbers each, and
    /// stores each cylinder's contact force \[N\] in `contact`; returns the sum of the loads.
    pub(super) fn add_plane_forces(
        &self,
        contact: &mut [f64],
        force: &mut [f64],
    ) -> CylinderContact {
        let mut all = CylinderContact::default();
        let touching = self.touching();
        let (rows, _) = force.as_chunks_mut::<3>();
        let rows = rows[touching.clone()].chunks_mut(WIDEST);
        let contact = contact[touching].chunks_mut(WIDEST);
        for ((group, rows), contact) in self.groups().iter().zip(rows).zip(contact) {
            for (lane, (row, contact)) in rows.iter_mut().zip(contact).enumerate() {
                *contact = group.total[lane];
                row[0] += group.push[0][lane];
                row[1] += group.push[1][lane];
                row[2] += group.bend[1][lane] * group.axis[0][lane]
                    - group.bend[0][lane] * group.axis[1][lane];
                all.beam += group.beam[lane];
                all.lost += group.loss[lane];
            }
        }
        all
    }

    /// Returns the contact load of the `k`-th cylinder that may touch the arc.
    #[inline]
    pub(super) fn cylinder_contact(&self, k: usize) -> CylinderContact {
        let (group, lane) = self.at(k);
        CylinderContact {
            total: group.total[lane],
            push: V2::new(group.push[0][lane], group.push[1][lane]),
            bend: V2::new(group.bend[0][lane], group.bend[1][lane]),
            beam: group.beam[lane],
            lost: group.loss[lane],
        }
    }

    /// Iterates over the contact points under load on the `k`-th cylinder that may touch the arc.
    pub(super) fn loaded_points(&self, k: usize) -> impl Iterator<Item = usize> {
        let (group, lane) = self.at(k);
        let pressed = move |&i: &usize| self.share[i] * group.force[i][lane] != 0.0;
        (0..POINTS).filter(pressed)
    }

    /// Returns contact point `i` of the `k`-th cylinder that may touch the arc; the law must be that of the
    /// last evaluation.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn contact_point(&self, (k, i): (usize, usize), law: &Impact) -> ContactPoint {
        let (group, lane) = self.at(k);
        let along = self.along[i];
        let pair = |of: &[Each; 2]| of.each_ref().map(|each| each[lane]);
        let moved = |of: &[Each; 2], by: &[Each; 2]| {
            std::array::from_fn(|d| of[d][lane] + by[d][lane] * along)
        };
        let law = law.response([group.depth[i][lane]], [group.rate[i][lane]]);
        ContactPoint {
            along,
            velocity: moved(&group.velocity, &group.sweep),
            toward: moved(&group.toward, &group.axis),
            angle: group.angle[i][lane],
            slope: group.slope[i][lane],
            by_point: pair(&group.outward[i]).map(|x| -x),
            by_beam: group.by_beam[i][lane],
            law: law.scaled(self.share[i]),
        }
    }

    /// Returns the derivatives of the contact force at point `i` of the `k`-th cylinder that may touch the arc
    /// with respect to stiffness and damping of the law.
    pub(super) fn by_law(&self, (k, i): (usize, usize), law: &Impact) -> [f64; 2] {
        let (group, lane) = self.at(k);
        let by = law.by_coefficients([group.depth[i][lane]], [group.rate[i][lane]]);
        by.map(|[by]| self.share[i] * by)
    }

    /// Adds the elastic energy of the contact at all points to `sum` \[J\].
    pub(super) fn add_energy(&self, sum: &mut f64, law: &Impact) {
        for k in 0..self.touching.len() {
            let (group, lane) = self.at(k);
            for i in 0..POINTS {
                let at = law.response([group.depth[i][lane]], [group.rate[i][lane]]);
                *sum += self.share[i] * at.energy;
            }
        }
    }

    /// Returns the largest penetration among all contact points \[m\], at least 0.
    pub(super) fn deepest(&self) -> f64 {
        let deeper = |deepest: f64, &depth: &f64| if depth > deepest { depth } else { deepest };
        // lanes beyond the last cylinder repeat it
        let depths = self
            .groups()
            .iter()
            .flat_map(|group| group.depth.as_flattened());
        depths.fold(0.0, deeper)
    }

    /// Distributes the contact forces to the knots (grid points) of the arc's mode shapes, into `pressure`.
    pub(super) fn distribute_to_knots(&self, shapes: &Splines, pressure: &mut KnotForces) {
        pressure.clear(shapes);
        if self.height == Height::Local {
            let lanes = self
                .groups()
                .iter()
                .flat_map(|group| (0..WIDEST).map(move |k| (group, k)));
            for (group, lane) in lanes.take(self.touching.len()) {
                if group.total[lane] != 0.0 {
                    let moments = group.moments.each_ref().map(|moment| moment[lane]);
                    pressure.add_moments(index(group.left[lane]), &moments);
                }
            }
            return;
        }
        for k in 0..self.touching.len() {
            let (group, lane) = self.at(k);
            for i in self.loaded_points(k) {
                let place = shapes.place(group.angle[i][lane]);
                pressure.add(&place, self.share[i] * group.force[i][lane]);
            }
        }
    }

    /// Iterates over pairs of arc angle \[rad\] and contact force \[N\] of all contact points.
    pub(crate) fn forces(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        (0..self.touching.len()).flat_map(|k| {
            let (group, lane) = self.at(k);
            let point = |i: usize| (group.angle[i][lane], self.share[i] * group.force[i][lane]);
            std::array::from_fn::<_, POINTS, _>(point)
        })
    }
}

/// Replacement of the forces at all contact points by their derivatives, compiled for each set of instructions.
struct Differentiate<'a> {
    groups: &'a mut [Group],
    law: &'a Impact,
    by: DerivativeVariable,
    /// Positions of the points along their cylinders and shares of the contact coefficients.
    points: [&'a [f64; POINTS]; 2],
    local: bool,
}

impl WithSimd for Differentiate<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for group in self.groups {
            group.differentiate(simd, self.law, self.by);
            group.sum_forces(simd, self.points, self.local);
        }
    }
}

/// Evaluation of geometry and law at all contact points, compiled for each set of instructions.
struct Evaluate<'a, 's> {
    points: &'a mut Points,
    surface: &'a Surface<'s>,
    law: &'a Impact,
    cylinders: Cylinders<'a>,
}

impl WithSimd for Evaluate<'_, '_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            points,
            surface,
            law,
            cylinders,
        } = self;
        let n = points.touching.len();
        if n == 0 {
            return;
        }
        let groups = &mut points.groups[..n.div_ceil(WIDEST)];
        match cylinders {
            Cylinders::Plane(poses) => {
                place_plane(simd, groups, surface, poses, points.touching.start);
            }
            Cylinders::Space(poses) => {
                place_space(groups, surface, &poses[points.touching.clone()]);
            }
        }
        repeat_last(groups, n);
        if points.height != Height::Circular {
            find_bearings(simd, groups, surface);
        }
        if points.height == Height::Local {
            find_on_grid(groups, surface);
        }
        let share = [&points.along, &points.share];
        match points.height {
            Height::Circular => evaluate::<S, CIRCULAR>(simd, groups, (surface, law), share),
            Height::Local => evaluate::<S, LOCAL>(simd, groups, (surface, law), share),
            Height::AtPoints => evaluate::<S, AT_POINTS>(simd, groups, (surface, law), share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spline::{Splines, sum::WeightedSplines};
    use crate::model::contact::Deflection;
    use crate::model::description::Arc;
    use crate::model::extension::profile::{Hollow, Profile};

    use crate::model::chain::contact_point::ModeShapes;
    use crate::model::contact::Curvature;

    /// Contact point in a test, with all its derivatives.
    struct Seen {
        depth: f64,
        rate: f64,
        angle: f64,
        by_point: V2,
        by_beam: f64,
        curvature: Curvature<f64>,
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
                let mut points = Points::new(&chain);
                let mut poses = PlanePoses::new(1);
                poses.fill(&x[..3], &MOTION[..3]);
                points.evaluate(&chain, &surface, &law, Cylinders::Plane(&poses));
                assert_eq!(points.touching(), 0..1);
                let (group, _) = points.at(0);
                assert!(group.depth[i][0] > -0.5, "beyond the surface's reach");
                let [x, y] = group.outward[i];
                Seen {
                    depth: group.depth[i][0],
                    rate: group.rate[i][0],
                    angle: group.angle[i][0],
                    by_point: V2::new(-x[0], -y[0]),
                    by_beam: group.by_beam[i][0],
                    curvature: {
                        let touch = points.contact_point((0, i), &law);
                        let mut shapes = ModeShapes::<3>::ZERO;
                        let border = surface.modes() + 1;
                        let [second, _] = shapes.fill(&surface, border, touch.angle);
                        surface.curvature(touch.toward, [touch.slope, second])
                    },
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
                    (by.by_point - V2::from(curvature.point[k])).norm() < 1e-7,
                    "{k} {} {}",
                    by.by_point,
                    V2::from(curvature.point[k])
                );
                assert!((by.by_beam - curvature.mixed[k]).abs() < 1e-7);
                assert!(!turns || (by.angle - angle_by_point[k]).abs() < 1e-8);
            } else {
                assert!((by.depth - touch.by_beam).abs() < 1e-8);
                assert!(
                    (by.by_point - V2::from(curvature.mixed)).norm() < 1e-7,
                    "{} {:?}",
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
