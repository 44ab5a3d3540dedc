//! Contact of a rope cylinder with an arc on the beam: geometry, and where the law is evaluated.
//!
//! Penetration of the point `g` on the cylinder's axis:
//! `d = R + sum_k q_k phi_k(s) - |g - C(theta)|`, `s = arg(g - C) - theta`; the rope's radius is
//! part of `R`. The generalised force is `-f grad d`. A cylinder touches along its length: the law
//! is integrated by three Gauss points, whose weights share the cylinder's coefficients.
use crate::effect::Profile;
use crate::math::elementary::{atan2, sin_cos};
use crate::math::spline::sum::Sum;
use crate::math::spline::{Place, Splines};
use crate::model::description::Arc;
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

/// Penetration of one point with its first derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Penetration, positive inside \[m\].
    pub depth: f64,
    /// Its rate [m/s].
    pub rate: f64,
    /// Arc angle in the beam frame \[rad\]; 0 where the surface is a circle.
    pub angle: f64,
    /// Outward normal and tangent (growing angle).
    pub normal: V2,
    /// Tangent.
    pub tangent: V2,
    /// Distance from the centre \[m\].
    pub distance: f64,
    /// Derivative by the point.
    pub by_point: V2,
    /// Derivative by the beam angle.
    pub by_beam: f64,
    /// Slope and curvature of the deflected surface over the arc angle [m/rad], [m/rad^2].
    pub slope: [f64; 2],
    /// Where on the grid of the shapes it lies, if there are any.
    pub place: Option<Place>,
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

    /// The bearing of a cylinder of half length `half` centred at `g`, if it may touch at all.
    #[inline]
    pub fn bearing(&self, g: &V2, half: f64) -> Option<Bearing> {
        self.bearing_after(None, g, half)
    }

    /// The same, from the bearing of a neighbour if there is one: a few products in place of an arc
    /// tangent.
    #[inline]
    pub fn bearing_after(&self, before: Option<&Bearing>, g: &V2, half: f64) -> Option<Bearing> {
        let reach = self.reach + half;
        let w = g - self.center;
        if w.norm_squared() >= reach * reach {
            return None;
        }
        let angle = match before {
            _ if !self.asks_for_angle() => 0.0,
            Some(before) if near(&before.toward, &w) => self.angle_at(before, &w),
            _ => self.arc_angle(&w),
        };
        Some(Bearing { toward: w, angle })
    }

    /// Arc angle in the beam frame \[rad\] in a direction near a bearing; 0 where the surface is a
    /// circle.
    #[inline]
    pub fn angle_at(&self, bearing: &Bearing, toward: &V2) -> f64 {
        if self.asks_for_angle() {
            bearing.angle + small_angle(bearing.toward.into(), (*toward).into())
        } else {
            0.0
        }
    }

    /// Penetration of the point `g` that moves with `velocity`; none where it lies beyond what any
    /// deflection reaches.
    #[expect(
        clippy::inline_always,
        reason = "forces need a third of a touch; inlined, the rest is never computed"
    )]
    #[inline(always)]
    pub fn touch(&self, bearing: &Bearing, g: &V2, velocity: &V2) -> Option<Touch> {
        let w = g - self.center;
        let square = w.norm_squared();
        if square >= self.reach * self.reach {
            return None;
        }
        let distance = square.sqrt();
        let inverse = 1.0 / distance;
        let normal = w * inverse;
        let tangent = V2::new(-normal.y, normal.x);
        let angle = self.angle_at(bearing, &w);
        let (mut bulge, mut rate, mut slope, mut place) = (0.0, 0.0, [0.0; 2], None);
        if let Some(bend) = &self.bend {
            let at = bend.shapes.place(angle);
            let (deflected, bulging) = bend.sum.at(bend.shapes, &at);
            bulge = deflected.value;
            slope = [deflected.first, deflected.second];
            rate = bulging;
            place = Some(at);
        }
        if let Some(profile) = self.profile {
            let [height, first, second] = profile.height(angle);
            bulge += height;
            slope[0] += first;
            slope[1] += second;
        }
        let by_point = tangent * (slope[0] * inverse) - normal;
        let by_beam = -by_point.dot(&self.center_by_beam) - slope[0];
        Some(Touch {
            depth: self.radius + bulge - distance,
            rate: rate + by_point.dot(velocity) + by_beam * self.beam[1],
            angle,
            normal,
            tangent,
            distance,
            by_point,
            by_beam,
            slope,
            place,
        })
    }

    /// Radial shapes of the modes at a touch.
    pub fn shapes_at(&self, touch: &Touch, shape: &mut [f64]) {
        if let (Some(bend), Some(place)) = (&self.bend, &touch.place) {
            bend.shapes.values(place, shape);
        }
    }

    /// Arc angle of a direction in the beam frame, in [0, 2 pi).
    fn arc_angle(&self, direction: &V2) -> f64 {
        let turn = std::f64::consts::TAU;
        let angle = atan2(direction.y, direction.x) - self.beam[0];
        angle - turn * (angle / turn).floor()
    }

    /// Second derivatives at a touch.
    pub fn curvature(&self, touch: &Touch) -> Curvature {
        let (n, t, r) = (touch.normal, touch.tangent, touch.distance);
        let [s1, s2] = touch.slope;
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let (modal, rate) = ([0.3, -0.2], [0.5, 0.7]);
        let velocity = V2::new(0.4, -0.9);
        let at = |g: V2, theta: f64| {
            let mut sum = Sum::default();
            sum.weigh(&shapes, &modal, &rate);
            let bend = Bend {
                shapes: &shapes,
                sum: &sum,
                modal_rate: &rate,
            };
            let surface = Surface::new(&arc, [theta, 0.6], Some(bend));
            let bearing = surface.bearing(&V2::new(-1.94, -0.41), 0.1).unwrap();
            let touch = surface.touch(&bearing, &g, &velocity).unwrap();
            (touch, surface.curvature(&touch))
        };
        let (g, theta) = (V2::new(-1.93, -0.4), 0.2);
        let (touch, curvature) = at(g, theta);
        let h = 1e-6;
        for k in 0..3 {
            let step = |h: f64| {
                let mut g = g;
                let mut theta = theta;
                if k < 2 {
                    g[k] += h;
                } else {
                    theta += h;
                }
                at(g, theta).0
            };
            let (plus, minus) = (step(h), step(-h));
            let first = (plus.depth - minus.depth) / (2.0 * h);
            let point = (plus.by_point - minus.by_point) / (2.0 * h);
            let beam = (plus.by_beam - minus.by_beam) / (2.0 * h);
            let angle = (plus.angle - minus.angle) / (2.0 * h);
            if k < 2 {
                assert!((first - touch.by_point[k]).abs() < 1e-8);
                assert!(
                    (point - curvature.point.column(k)).norm() < 1e-7,
                    "{k} {point} {}",
                    curvature.point
                );
                assert!((beam - curvature.mixed[k]).abs() < 1e-7);
                assert!((angle - curvature.angle_by.0[k]).abs() < 1e-8);
            } else {
                assert!((first - touch.by_beam).abs() < 1e-8);
                assert!(
                    (point - curvature.mixed).norm() < 1e-7,
                    "{point} {}",
                    curvature.mixed
                );
                assert!(
                    (beam - curvature.beam).abs() < 1e-7,
                    "{beam} {}",
                    curvature.beam
                );
                assert!((angle - curvature.angle_by.1).abs() < 1e-8);
            }
        }
    }
}
