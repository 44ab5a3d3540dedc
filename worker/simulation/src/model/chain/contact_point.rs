//! Derivatives of the penetration and the force of one contact point of a chain, or of several side by side in
//! SIMD lanes.
use super::points::ContactPoint;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::element::law::LawResponse;
use crate::math::real::Real;
use crate::model::contact::{Curvature, Surface};
use crate::model::layout::MAX_MODES;
use crate::model::pose::InPlane;

/// Largest number of cylinder coordinates that move a contact point: two displacements and one or two angles.
pub(super) const OWN: usize = 4;
/// Largest number of border coordinates, which all cylinders share: the beam angle and the modes.
pub(crate) const BORDER: usize = MAX_MODES + 1;
/// Number of border coordinates (beam angle, modes) that suffices for a usual head; arrays of this length are
/// short enough for loops to be unrolled.
pub(crate) const FEW: usize = 8;

/// Contact point with all that its derivatives by its cylinder's coordinates and the beam angle depend on.
/// The cylinder's axis depends on `A` angles.
pub(super) struct PointMotion<T, const A: usize> {
    /// Position of the point along the cylinder's axis, from the centre \[m\]; the field `velocity` holds the
    /// point's velocity [m/s].
    pub(super) along: f64,
    pub(super) velocity: [T; 2],
    /// First derivatives of the penetration with respect to the point's position; the field `by_beam` holds
    /// that with respect to the beam angle, `curvature` the second derivatives.
    pub(super) by_point: [T; 2],
    pub(super) by_beam: T,
    pub(super) curvature: Curvature<T>,
    /// Sum of the slopes of the mode shapes along the arc, weighted by the modes' rates [m/(rad s)].
    pub(super) drift: T,
    /// Answer of the contact law, multiplied by the point's share of the contact coefficients.
    pub(super) law: LawResponse<T, 1>,
    /// Derivatives of the cylinder's axis and of the axis's time derivative with respect to the angles, and
    /// second derivatives of the axis.
    pub(super) axis_by: [[T; 2]; A],
    pub(super) sweep_by: [[T; 2]; A],
    pub(super) axis_by_twice: [[[T; 2]; A]; A],
}

/// Derivatives of a contact point's penetration, arc angle and force with respect to the coordinates of its
/// cylinder and to the beam angle. Of the cylinder's coordinates the first two and the angles count; numbers
/// beyond them are zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointTangent<T> {
    /// Derivatives of the penetration with respect to the cylinder's coordinates; the field `own_force` holds
    /// those of the force, at constant rates.
    pub(super) own: [T; OWN],
    pub(super) own_force: [T; OWN],
    /// Second derivatives of the penetration with respect to two of these coordinates, multiplied by the force:
    /// due to the point's motion along straight lines, and due to the bend of its path.
    pub(super) straight: [[T; OWN]; OWN],
    pub(super) bent: [[T; OWN]; OWN],
    /// Derivatives of the arc angle with respect to these coordinates; the field `mixed` holds the second
    /// derivatives of the penetration with respect to them and the beam angle.
    pub(super) angle: [T; OWN],
    pub(super) mixed: [T; OWN],
    /// Derivative of the force with respect to the beam angle, at constant rates.
    pub(super) force_by_beam: T,
    /// Rate of the arc angle times the damping of the law: derivative of the force with respect to a mode per
    /// slope of its shape.
    pub(super) force_by_slope: T,
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn dot<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the products of a vector with the displacements of a contact point by its cylinder's coordinates:
/// two displacements move the point by themselves, the angles as `moved` states.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn by_coordinates<T: Real, const A: usize>(of: [T; 2], moved: &[[T; 2]; A]) -> [T; OWN] {
    let mut all = [of[0].constant(0.0); OWN];
    all[..2].copy_from_slice(&of);
    for a in 0..A {
        all[2 + a] = dot(of, moved[a]);
    }
    all
}

impl<T: Real> PointTangent<T> {
    /// Computes the derivatives at a contact point.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(super) fn new<const A: usize>(surface: &Surface<'_>, at: &PointMotion<T, A>) -> Self {
        // loops in place of closures, which would not always be inlined
        let (along, velocity, by_point) = (at.along, at.velocity, at.by_point);
        let ([force], [[stiff]], [[damp]]) = (at.law.force, at.law.stiffness, at.law.damping);
        let Curvature {
            point: [[xx, xy], [_, yy]],
            mixed,
            beam,
            angle_by: (angle_by_point, angle_by_beam),
        } = at.curvature;
        let beam_rate = surface.beam[1];
        let angle_rate = dot(angle_by_point, velocity) + angle_by_beam * beam_rate;
        // rates of the gradient along the motion: H q'
        let turned = [dot([xx, xy], velocity), dot([xy, yy], velocity)];
        let mut by_place = by_point;
        for d in 0..2 {
            let rate = turned[d] + mixed[d] * beam_rate + angle_by_point[d] * at.drift;
            by_place[d] = by_point[d] * stiff + rate * damp;
        }
        let beam_gradient_rate = dot(mixed, velocity) + beam * beam_rate + angle_by_beam * at.drift;
        let mut moved = at.axis_by;
        for arm in &mut moved {
            *arm = [arm[0] * along, arm[1] * along];
        }
        let zero = force.constant(0.0);
        let mut own_force = by_coordinates(by_place, &moved);
        let mut bent = [[zero; OWN]; OWN];
        for a in 0..A {
            let turning = dot(by_point, at.sweep_by[a]) * along;
            own_force[2 + a] = own_force[2 + a] + damp * turning;
            for b in 0..A {
                let [x, y] = at.axis_by_twice[a][b];
                bent[2 + a][2 + b] = force * dot(by_point, [x * along, y * along]);
            }
        }
        let [x, y] = [[xx * force, xy * force], [xy * force, yy * force]];
        let mut straight = [[zero; OWN]; OWN];
        straight[0] = by_coordinates(x, &moved);
        straight[1] = by_coordinates(y, &moved);
        for a in 0..A {
            straight[2 + a] = by_coordinates([dot(x, moved[a]), dot(y, moved[a])], &moved);
        }
        Self {
            own: by_coordinates(by_point, &moved),
            own_force,
            straight,
            bent,
            angle: by_coordinates(angle_by_point, &moved),
            mixed: by_coordinates(mixed, &moved),
            force_by_beam: at.by_beam * stiff + beam_gradient_rate * damp,
            force_by_slope: angle_rate * damp,
        }
    }
}

/// Values and slopes of the mode shapes at a contact point, one per border coordinate: derivatives of the
/// penetration with respect to the modes, and of these with respect to the arc angle. Zero for the beam angle
/// and beyond the last mode.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModeShapes<const B: usize> {
    pub(super) value: [f64; B],
    pub(super) slope: [f64; B],
}

impl<const B: usize> ModeShapes<B> {
    pub(super) const ZERO: Self = Self {
        value: [0.0; B],
        slope: [0.0; B],
    };

    /// Computes the shapes at the arc angle `angle` for the first `border` border coordinates; returns the
    /// surface's second derivative with respect to the arc angle, and the sum of the slopes weighted by the
    /// modes' rates.
    #[inline]
    pub(super) fn fill(&mut self, surface: &Surface<'_>, border: usize, angle: f64) -> [f64; 2] {
        let (mut second, mut drift) = (0.0, 0.0);
        if let Some(bend) = &surface.bend {
            let place = bend.shapes.place(angle);
            let modes = 1..border;
            let (values, slopes) = (
                &mut self.value[modes.clone()],
                &mut self.slope[modes.clone()],
            );
            bend.shapes.slopes(&place, values, slopes);
            for (k, rate) in modes.zip(bend.modal_rate) {
                drift += rate * self.slope[k];
            }
            second = bend.sum.at(bend.shapes, &place).0.second;
        }
        if let Some(profile) = surface.profile {
            second += profile.height(angle)[2];
        }
        [second, drift]
    }
}

/// Contact point under load of a cylinder in the plane, with the derivatives of its force and arc angle;
/// gauge stress is differentiated with them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoadedPoint<const B: usize> {
    /// Contact force \[N\]; the field `angle` holds the arc angle of the point \[rad\].
    pub(crate) force: f64,
    pub(crate) angle: f64,
    /// Derivatives of the force with respect to stiffness and damping of the contact law.
    pub(crate) by_law: [f64; 2],
    /// Derivatives of the contact force with respect to the cylinder's coordinates and to their rates; the
    /// field `angle_by` holds those of the arc angle.
    pub(crate) force_by: [[f64; 3]; 2],
    pub(crate) angle_by: [f64; 3],
    /// Derivatives of the contact force with respect to the border coordinates (beam angle, then modes) and
    /// to their rates. Of these coordinates, only the beam angle changes the arc angle (field
    /// `angle_by_beam`).
    pub(crate) force_by_border: [[f64; B]; 2],
    pub(crate) angle_by_beam: f64,
}

/// Calls `visit` with every loaded contact point and its cylinder's index, for a chain in the plane; there is
/// room for `B` border coordinates (beam angle, modes).
pub(crate) fn for_each_loaded_point<const B: usize>(
    (surface, law): (&Surface<'_>, &Impact),
    state: &ChainState,
    mut visit: impl FnMut(usize, &LoadedPoint<B>),
) {
    let points = &state.points;
    let mut shapes = ModeShapes::ZERO;
    for (k, j) in points.touching().enumerate() {
        for i in points.loaded_points(k) {
            let touch = points.contact_point((k, i), law);
            let measures = shapes.fill(surface, surface.modes() + 1, touch.angle);
            let at = touch.motion(surface, &state.plane.get(j), measures);
            let point = PointTangent::new(surface, &at);
            let ([[stiff]], [[damp]]) = (touch.law.stiffness, touch.law.damping);
            let mut gradient = shapes.value;
            gradient[0] = touch.by_beam;
            let mut by_border: [f64; B] = std::array::from_fn(|k| {
                shapes.value[k] * stiff + shapes.slope[k] * point.force_by_slope
            });
            by_border[0] = point.force_by_beam;
            let three = |of: [f64; OWN]| [of[0], of[1], of[2]];
            let reached = LoadedPoint {
                force: touch.law.force[0],
                angle: touch.angle,
                by_law: points.by_law((k, i), law),
                force_by: [
                    three(point.own_force),
                    three(point.own.map(|own| damp * own)),
                ],
                angle_by: three(point.angle),
                force_by_border: [by_border, gradient.map(|x| damp * x)],
                angle_by_beam: at.curvature.angle_by.1,
            };
            visit(j, &reached);
        }
    }
}

impl ContactPoint {
    /// Returns the point with the motion of its cylinder; `second` and `drift` are the result of
    /// [`ModeShapes::fill`].
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn motion<const A: usize>(
        &self,
        surface: &Surface<'_>,
        pose: &impl InPlane<A>,
        [second, drift]: [f64; 2],
    ) -> PointMotion<f64, A> {
        let pair = |v: nalgebra::Vector2<f64>| [v.x, v.y];
        PointMotion {
            along: self.along,
            velocity: self.velocity,
            by_point: self.by_point,
            by_beam: self.by_beam,
            curvature: surface.curvature(self.toward, [self.slope, second]),
            drift,
            law: self.law,
            axis_by: pose.axis_by().map(pair),
            sweep_by: pose.sweep_by().map(pair),
            axis_by_twice: std::array::from_fn(|a| {
                std::array::from_fn(|b| pair(pose.axis_by_twice(a, b)))
            }),
        }
    }
}
