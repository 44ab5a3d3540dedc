//! Contact of a rope cylinder with an arc on the beam: the arc, and where the law is evaluated.
//!
//! Penetration of the point `g` on the cylinder's axis:
//! `d = R + sum_k q_k phi_k(s) - |g - C(theta)|`, `s = arg(g - C) - theta`; the rope's radius is
//! part of `R`. The generalised force is `-f grad d`. A cylinder touches along its length: the law
//! is integrated by three Gauss points, whose weights share the cylinder's coefficients.
use crate::math::elementary::{atan2, sin_cos};
use crate::math::spline::sum::Sum;
use crate::math::spline::{Place, Splines};
use crate::model::description::Arc;
use crate::model::hook::profile::Profile;
use nalgebra::{Matrix2, Vector2};

type V2 = Vector2<f64>;

/// Points of a cylinder where its contact is evaluated.
pub const POINTS: usize = 3;

/// Places along a cylinder in half lengths, and their shares of its coefficients.
pub const GAUSS: [(f64, f64); POINTS] = [
    (-0.774_596_669_241_483_4, 5.0 / 18.0),
    (0.0, 8.0 / 18.0),
    (0.774_596_669_241_483_4, 5.0 / 18.0),
];

/// An arc at an instant: rigid placement and deflection.
#[derive(Clone, Debug)]
pub struct Surface<'a> {
    /// Centre \[m\].
    pub center: V2,
    /// Derivative of the centre by the beam angle \[m\].
    pub center_by_beam: V2,
    /// Radius of the rope's centre line \[m\].
    pub radius: f64,
    /// Beam angle \[rad\] and rate [rad/s].
    pub beam: [f64; 2],
    /// Distance from the centre beyond which nothing touches, however the arc is deflected \[m\].
    pub reach: f64,
    /// What bends it, if anything does.
    pub bend: Option<Bend<'a>>,
    /// Where it is not the circle, if anywhere.
    pub profile: Option<&'a Profile>,
}

/// Deflection of an arc by modes.
#[derive(Clone, Copy, Debug)]
pub struct Bend<'a> {
    /// Radial shapes of the modes over the arc angle \[rad\].
    pub shapes: &'a Splines,
    /// Their sum under the modal coordinates, and under their rates.
    pub sum: &'a Sum,
    /// Rates of the modal coordinates.
    pub modal_rate: &'a [f64],
}

/// How far beyond the rigid arc the head's own deflection may reach for contact \[m\].
const LARGEST_BULGE: f64 = 0.01;

/// Where a cylinder's centre lies, seen from the arc's centre: one arc tangent serves all of its
/// Gauss points.
#[derive(Clone, Copy, Debug)]
pub struct Bearing {
    toward: V2,
    angle: f64,
}

/// Whether the angle between two vectors is below 0.06 rad.
#[inline]
fn near(a: &V2, b: &V2) -> bool {
    let (along, across) = (a.dot(b), a.x * b.y - a.y * b.x);
    across.abs() < 0.06 * along
}

impl Bearing {
    /// From the arc's centre to the cylinder's \[m\].
    pub const fn toward(&self) -> V2 {
        self.toward
    }

    /// Arc angle there, in the beam frame \[rad\]; 0 where the surface is a circle.
    pub const fn angle(&self) -> f64 {
        self.angle
    }
}

/// Angle from `a` to `b` \[rad\], by the arc tangent's series: Gauss points of one cylinder lie
/// within a few hundredths of a radian, where the first term left out is below 1e-17.
#[inline]
pub(crate) fn small_angle(a: [f64; 2], b: [f64; 2]) -> f64 {
    let t = (a[0] * b[1] - a[1] * b[0]) / (a[0] * b[0] + a[1] * b[1]);
    let u = t * t;
    t * (1.0
        - u * (1.0 / 3.0
            - u * (0.2 - u * (1.0 / 7.0 - u * (1.0 / 9.0 - u * (1.0 / 11.0 - u / 13.0))))))
}

/// Second derivatives of a penetration.
#[derive(Clone, Copy, Debug)]
pub struct Curvature {
    /// By the point twice.
    pub point: Matrix2<f64>,
    /// By the point and the beam angle.
    pub mixed: V2,
    /// By the beam angle twice.
    pub beam: f64,
    /// Derivatives of the arc angle by the point and by the beam angle: with the slope of a mode
    /// they give its mixed derivatives.
    pub angle_by: (V2, f64),
}

impl<'a> Surface<'a> {
    /// Places an arc.
    pub fn new(arc: &Arc, beam: [f64; 2], bend: Option<Bend<'a>>) -> Self {
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

    /// Whether it is more than a circle.
    pub(crate) const fn asks_for_angle(&self) -> bool {
        self.bend.is_some() || self.profile.is_some()
    }

    /// Number of modes that bend it.
    pub fn modes(&self) -> usize {
        self.bend.map_or(0, |bend| bend.shapes.curves())
    }

    /// The bearing of a cylinder of half length `half` centred at `g`, if it may touch at all: from
    /// that of a neighbour, if there is one, by a few products in place of an arc tangent.
    #[inline]
    pub fn bearing(&self, before: Option<&Bearing>, g: &V2, half: f64) -> Option<Bearing> {
        let reach = self.reach + half;
        let w = g - self.center;
        if w.norm_squared() >= reach * reach {
            return None;
        }
        let angle = match before {
            _ if !self.asks_for_angle() => 0.0,
            Some(before) if near(&before.toward, &w) => {
                before.angle + small_angle(before.toward.into(), w.into())
            }
            _ => self.arc_angle(&w),
        };
        Some(Bearing { toward: w, angle })
    }

    /// Arc angle of a direction in the beam frame, in [0, 2 pi).
    fn arc_angle(&self, direction: &V2) -> f64 {
        let turn = std::f64::consts::TAU;
        let angle = atan2(direction.y, direction.x) - self.beam[0];
        angle - turn * (angle / turn).floor()
    }

    /// Second derivatives of the penetration of a point that lies `toward` from the centre, at arc
    /// angle `angle` and at `place` on the grid of the shapes, where the surface has the slope `s1`
    /// over the arc [m/rad].
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub fn curvature(&self, toward: &V2, angle: f64, place: &Place, s1: f64) -> Curvature {
        let r = toward.norm();
        let n = toward * (1.0 / r);
        let t = V2::new(-n.y, n.x);
        let s2 = self.bent(angle, place);
        let c = self.center_by_beam;
        // C - O turned by the beam: d2C/dtheta2 = -(C - O)
        let arm = self.center;
        let tt = t * t.transpose();
        let nt = n * t.transpose();
        let angle_by_point = t / r;
        let angle_by_beam = -1.0 - t.dot(&c) / r;
        let point = tt * (s2 / (r * r) - 1.0 / r) - (nt + nt.transpose()) * (s1 / (r * r));
        // the point's distance and angle depend on g - C(theta) only, s also on theta itself
        let rigid = tt * (-1.0 / r) - (nt + nt.transpose()) * (s1 / (r * r));
        let mixed = -(rigid * c) + angle_by_point * (s2 * angle_by_beam);
        let beam = c.dot(&(rigid * c)) + s2 * angle_by_beam * angle_by_beam - n.dot(&arm)
            + s1 * t.dot(&arm) / r;
        Curvature {
            point,
            mixed,
            beam,
            angle_by: (angle_by_point, angle_by_beam),
        }
    }

    /// Second derivative of the surface's height over the arc angle [m/rad^2].
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    fn bent(&self, angle: f64, place: &Place) -> f64 {
        let modes = self.bend.as_ref();
        let modes = modes.map_or(0.0, |bend| bend.sum.at(bend.shapes, place).0.second);
        modes + self.profile.map_or(0.0, |profile| profile.height(angle)[2])
    }
}
