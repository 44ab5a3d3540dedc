//! Derivatives of the penetration and the force of one contact point of a chain.
use super::points::ContactPoint;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::model::contact::Surface;
use crate::model::layout::MAX_MODES;
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Largest number of cylinder coordinates that move a contact point: two displacements and one or two angles.
pub(super) const OWN: usize = 4;
/// Largest number of border coordinates, which all cylinders share: the beam angle and the modes.
pub(crate) const BORDER: usize = MAX_MODES + 1;
/// Number of border coordinates (beam angle, modes) that suffices for a usual head; arrays of this length are
/// short enough for loops to be unrolled.
pub(crate) const FEW: usize = 8;

/// Derivatives of a contact point's penetration and force, with room for `B` border coordinates (beam angle,
/// modes).
pub(super) struct Derivatives<const B: usize> {
    /// Derivatives of the penetration with respect to the cylinder's coordinates; the field `own_force` holds
    /// those of the force.
    pub(super) own: [f64; OWN],
    pub(super) own_force: [f64; OWN],
    /// Derivatives of the point's position with respect to the cylinder's coordinates.
    pub(super) moved: [V2; OWN],
    /// Derivatives of the penetration with respect to the border coordinates (beam angle, modes); the field
    /// `force_by` holds those of the force.
    pub(super) gradient: [f64; B],
    pub(super) force_by: [f64; B],
    /// Slopes of the mode shapes along the arc at the contact point, one per border coordinate; zero for the
    /// beam angle.
    pub(super) slope: [f64; B],
}

impl<const B: usize> Derivatives<B> {
    /// Computes the derivatives of penetration and force with respect to all coordinates, at constant rates;
    /// `border` is the number of border coordinates included.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn new<const A: usize>(
        (surface, border): (&Surface<'_>, usize),
        pose: &impl InPlane<A>,
        touch: &ContactPoint,
    ) -> Self {
        let ContactPoint {
            along,
            velocity,
            curvature,
            law: at,
            ..
        } = touch;
        let ([[stiff]], [[damp]]) = (at.stiffness, at.damping);
        let (angle_by_point, angle_by_beam) = curvature.angle_by;
        let beam_rate = surface.beam[1];
        let angle_rate = angle_by_point.dot(velocity) + angle_by_beam * beam_rate;
        let mut gradient = [0.0; B];
        let mut force_by = [0.0; B];
        let mut slope = [0.0; B];
        let mut drift = 0.0;
        if let Some(bend) = &surface.bend {
            let modes = 1..border;
            let (values, slopes) = (&mut gradient[modes.clone()], &mut slope[modes.clone()]);
            bend.shapes.slopes(&touch.on_grid, values, slopes);
            for (k, rate) in modes.clone().zip(bend.modal_rate) {
                drift += rate * slope[k];
            }
            for k in modes {
                force_by[k] = gradient[k] * stiff + slope[k] * (angle_rate * damp);
            }
        }
        // rates of the gradient along the motion: H q'
        let point_rate =
            curvature.point * velocity + curvature.mixed * beam_rate + angle_by_point * drift;
        let beam_gradient_rate =
            curvature.mixed.dot(velocity) + curvature.beam * beam_rate + angle_by_beam * drift;
        gradient[0] = touch.by_beam;
        force_by[0] = touch.by_beam * stiff + beam_gradient_rate * damp;

        let (arms, sweeps) = (pose.axis_by(), pose.sweep_by());
        let moved: [V2; OWN] = std::array::from_fn(|k| match k {
            0 => V2::x(),
            1 => V2::y(),
            k => arms.get(k - 2).map_or_else(V2::zeros, |arm| arm * *along),
        });
        let by_place = touch.by_point * stiff + point_rate * damp;
        Self {
            own: moved.map(|moved| touch.by_point.dot(&moved)),
            own_force: std::array::from_fn(|k| {
                let turning = k.checked_sub(2).and_then(|a| sweeps.get(a));
                let turning = turning.map_or(0.0, |sweep| along * touch.by_point.dot(sweep));
                by_place.dot(&moved[k]) + damp * turning
            }),
            moved,
            gradient,
            force_by,
            slope,
        }
    }

    /// Adds `factor` times the derivatives of the penetration to those of the force, for coordinates whose
    /// rates change with them.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn add_rates(&mut self, factor: f64) {
        let own = self.own_force.iter_mut().zip(&self.own);
        let border = self.force_by.iter_mut().zip(&self.gradient);
        for (by, gradient) in own.chain(border) {
            *by += factor * gradient;
        }
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
    let seen = (surface, surface.modes() + 1);
    let points = &state.points;
    for (k, j) in points.touching().enumerate() {
        for i in points.loaded_points(k) {
            let touch = points.contact_point((k, i), surface, law);
            let point = Derivatives::<B>::new(seen, &state.plane.get(j), &touch);
            let (angle_by_point, angle_by_beam) = touch.curvature.angle_by;
            let own = |of: &dyn Fn(usize) -> f64| std::array::from_fn(of);
            let by_rate = touch.law.damping[0][0];
            let reached = LoadedPoint {
                force: touch.law.force[0],
                angle: touch.angle,
                by_law: points.by_law((k, i), law),
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
