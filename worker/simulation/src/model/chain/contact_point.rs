//! What one point of a chain's contact has as derivatives, of its penetration and of its force.
use super::points::Touch;
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::model::contact::Surface;
use crate::model::layout::MAX_MODES;
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Coordinates that move a point of a cylinder: two, and one or two angles.
pub(super) const OWN: usize = 4;
/// Most coordinates of the border: the beam angle, then the modes.
pub(crate) const BORDER: usize = MAX_MODES + 1;
/// Those of a usual head, whose sums are short enough to be unrolled.
pub(crate) const FEW: usize = 8;

/// A point's derivatives; there is room for `B` coordinates of the border.
pub(super) struct Derivatives<const B: usize> {
    /// Of the penetration and of the force by the cylinder's coordinates.
    pub(super) own: [f64; OWN],
    pub(super) own_force: [f64; OWN],
    /// How those move the point.
    pub(super) moved: [V2; OWN],
    /// Of the penetration and of the force by the border's coordinates.
    pub(super) gradient: [f64; B],
    pub(super) force_by: [f64; B],
    /// Slopes of the modes' shapes over the arc; the beam angle has none.
    pub(super) slope: [f64; B],
}

impl<const B: usize> Derivatives<B> {
    /// Derivatives of penetration and force by all coordinates.
    /// Rates change `gamma` times as much as coordinates; so many coordinates of the border take part.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub(super) fn new<const A: usize>(
        (surface, gamma, border): (&Surface<'_>, f64, usize),
        pose: &impl InPlane<A>,
        touch: &Touch,
    ) -> Self {
        let Touch {
            along,
            velocity,
            curvature,
            law: at,
            ..
        } = touch;
        let stiff = at.by_penetration + gamma * at.by_rate;
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
        Self {
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
}

/// A pressed point as a reading asks for it, of a cylinder that moves in the plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached<const B: usize> {
    /// Force \[N\] and arc angle \[rad\].
    pub(crate) force: f64,
    pub(crate) angle: f64,
    /// Derivatives of the force by stiffness and by damping of the law.
    pub(crate) by_law: [f64; 2],
    /// Derivatives of the force by the cylinder's coordinates and by their rates, and of the angle.
    pub(crate) force_by: [[f64; 3]; 2],
    pub(crate) angle_by: [f64; 3],
    /// The same by the beam angle, then by the modes, which turn no angle.
    pub(crate) force_by_border: [[f64; B]; 2],
    pub(crate) angle_by_beam: f64,
}

/// Gives every pressed point of a chain's cylinders that move in the plane, and its cylinder; there is room for
/// `B` coordinates of the border.
pub(crate) fn each_reached<const B: usize>(
    (surface, law): (&Surface<'_>, &Impact),
    state: &ChainState,
    mut visit: impl FnMut(usize, &Reached<B>),
) {
    let seen = (surface, 0.0, surface.modes() + 1);
    let points = &state.points;
    for (k, &j) in points.cylinders().iter().enumerate() {
        for i in points.touching(k) {
            let touch = points.touch((k, i), surface, law);
            let point = Derivatives::<B>::new(seen, &state.plane[j], &touch);
            let (angle_by_point, angle_by_beam) = touch.curvature.angle_by;
            let own = |of: &dyn Fn(usize) -> f64| std::array::from_fn(of);
            let by_rate = touch.law.by_rate;
            let reached = Reached {
                force: touch.law.force,
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
