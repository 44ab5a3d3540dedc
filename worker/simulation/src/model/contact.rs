//! Contact of a rope cylinder with an arc on the beam: geometry of the arc, and points at which the contact
//! law is evaluated.
//!
//! Penetration of the point `g` on the cylinder's axis: `d = R + sum_k q_k phi_k(s) - |g - C(theta)|` at the
//! arc angle `s = arg(g - C) - theta`, with arc centre `C`, beam angle `theta`, modal coordinates `q_k` and
//! radial mode shapes `phi_k`; the radius `R` is that of the rope's centre line. The generalised force is `-f
//! grad d`, with contact force `f`. A cylinder touches along its length: the law is integrated with three
//! Gauss points, whose weights divide the cylinder's coefficients.
use crate::math::elementary::{atan2, sin_cos};
use crate::math::real::Real;
use crate::math::spline::Splines;
use crate::math::spline::sum::WeightedSplines;
use crate::model::description::Arc;
use crate::model::extension::profile::Profile;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Number of contact evaluation points per cylinder.
pub const POINTS: usize = 3;

/// Gauss points along a cylinder: distance from its centre in half lengths, and share of the contact
/// coefficients.
pub const GAUSS: [(f64, f64); POINTS] = [
    (-0.774_596_669_241_483_4, 5.0 / 18.0),
    (0.0, 8.0 / 18.0),
    (0.774_596_669_241_483_4, 5.0 / 18.0),
];

/// Surface of a head's arc at one instant: centre, beam angle and deflection by modes.
#[derive(Clone, Debug)]
pub struct Surface<'a> {
    /// Centre of the arc in the world frame W \[m\].
    pub center: V2,
    /// Derivative of the arc's centre with respect to the beam angle \[m\].
    pub center_by_beam: V2,
    /// Radius of the centre line of a rope lying on the arc \[m\].
    pub radius: f64,
    /// Beam angle \[rad\] and rate [rad/s].
    pub beam: [f64; 2],
    /// Distance from the arc's centre beyond which no contact is considered, with room for deflection of the
    /// arc \[m\].
    pub reach: f64,
    /// Deflection of the arc by modes; `None` for a rigid arc.
    pub bend: Option<Deflection<'a>>,
    /// Permanent deviation of the surface from a circle; `None` for a circular arc.
    pub profile: Option<&'a Profile>,
}

/// Deflection of a head's arc by the head's modes.
#[derive(Clone, Copy, Debug)]
pub struct Deflection<'a> {
    /// Radial mode shapes as functions of the arc angle \[rad\].
    pub shapes: &'a Splines,
    /// Sums of the mode shapes weighted by the modal coordinates, and by the rates of these.
    pub sum: &'a WeightedSplines,
    /// Rates of the modal coordinates.
    pub modal_rate: &'a [f64],
}

/// Largest deflection of the head beyond the rigid arc that contact detection allows for \[m\].
const LARGEST_BULGE: f64 = 0.01;

/// Returns `turned` where the angle between two vectors is below 0.06 rad, otherwise not a number.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(crate) fn is_near<T: Real>(a: [T; 2], b: [T; 2], turned: T) -> T {
    let (along, across) = (a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]);
    let nan = turned.constant(f64::NAN);
    across
        .at_least(-across)
        .select_less(along * 0.06, turned, nan)
}

/// Returns the small angle from vector `a` to vector `b` \[rad\] by the series of the arc tangent; Gauss
/// points of one cylinder lie within a few hundredths of a radian, where the first omitted term is below
/// 1e-17.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(crate) fn small_angle<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    let t = (a[0] * b[1] - a[1] * b[0]) / (a[0] * b[0] + a[1] * b[1]);
    let u = -(t * t);
    let series = u * (1.0 / 13.0) + 1.0 / 11.0;
    let series = (u * series + 1.0 / 9.0) * u + 1.0 / 7.0;
    let series = (u * series + 0.2) * u + 1.0 / 3.0;
    t * (u * series + 1.0)
}

/// Second derivatives of the penetration of a contact point.
#[derive(Clone, Copy, Debug)]
pub struct Curvature<T> {
    /// Second derivatives of the penetration with respect to the point's position; symmetric.
    pub point: [[T; 2]; 2],
    /// Mixed second derivatives of the penetration with respect to the point's position and the beam angle.
    pub mixed: [T; 2],
    /// Second derivative of the penetration with respect to the beam angle.
    pub beam: T,
    /// Derivatives of the arc angle with respect to the point and the beam angle; multiplied by the slope of
    /// a mode's shape they give the mixed derivatives of the penetration with respect to that mode.
    pub angle_by: ([T; 2], T),
}

impl<'a> Surface<'a> {
    /// Places an arc at a beam angle \[rad\] and rate [rad/s], with an optional deflection.
    pub fn new(arc: &Arc, beam: [f64; 2], bend: Option<Deflection<'a>>) -> Self {
        let (s, c) = sin_cos(beam[0]);
        let [x, y] = arc.center;
        let center = V2::new(c * x - s * y, s * x + c * y);
        Self {
            center,
            center_by_beam: V2::new(-center.y, center.x),
            radius: arc.radius,
            beam,
            reach: arc.radius + LARGEST_BULGE,
            bend,
            profile: None,
        }
    }

    /// Returns the number of modes that deflect the arc.
    pub fn modes(&self) -> usize {
        self.bend.map_or(0, |bend| bend.shapes.curves())
    }

    /// Returns the arc angle of a direction from the arc's centre, in the beam frame, in [0, 2 pi).
    pub(crate) fn arc_angle(&self, direction: &V2) -> f64 {
        let turn = std::f64::consts::TAU;
        let angle = atan2(direction.y, direction.x) - self.beam[0];
        angle - turn * (angle / turn).floor()
    }

    /// Returns the second derivatives of a contact point's penetration. The point is at the vector `toward`
    /// from the arc's centre, where the surface's height has the derivatives `s1` and `s2` with respect to the
    /// arc angle [m/rad, m/rad^2].
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn curvature<T: Real>(&self, toward: [T; 2], [s1, s2]: [T; 2]) -> Curvature<T> {
        // closures would not always be inlined
        let one = s1.constant(1.0);
        let (c, arm) = (self.center_by_beam, self.center);
        let r = (toward[0] * toward[0] + toward[1] * toward[1]).sqrt();
        let inverse = one / r;
        let (nx, ny) = (toward[0] * inverse, toward[1] * inverse);
        let (tx, ty) = (-ny, nx);
        let angle_by_point = [tx / r, ty / r];
        let angle_by_beam = -one - (tx * c.x + ty * c.y) / r;
        let square = r * r;
        let [round, bent, tilt] = [-one / r, s2 / square - inverse, s1 / square];
        let tilted = [
            (nx * tx + nx * tx) * tilt,
            (nx * ty + ny * tx) * tilt,
            (ny * ty + ny * ty) * tilt,
        ];
        let [xx, xy, yy] = [tx * tx, tx * ty, ty * ty];
        // the point's distance and angle depend on g - C(theta) only, s also on theta itself; C - O turned by the
        // beam: d2C/dtheta2 = -(C - O)
        let rigid = [
            xx * round - tilted[0],
            xy * round - tilted[1],
            yy * round - tilted[2],
        ];
        let turned = [
            rigid[0] * c.x + rigid[1] * c.y,
            rigid[1] * c.x + rigid[2] * c.y,
        ];
        let rising = s2 * angle_by_beam;
        let beam = turned[0] * c.x + turned[1] * c.y + rising * angle_by_beam
            - (nx * arm.x + ny * arm.y)
            + s1 * (tx * arm.x + ty * arm.y) / r;
        let [xx, xy, yy] = [
            xx * bent - tilted[0],
            xy * bent - tilted[1],
            yy * bent - tilted[2],
        ];
        Curvature {
            point: [[xx, xy], [xy, yy]],
            mixed: [
                angle_by_point[0] * rising - turned[0],
                angle_by_point[1] * rising - turned[1],
            ],
            beam,
            angle_by: (angle_by_point, angle_by_beam),
        }
    }
}
