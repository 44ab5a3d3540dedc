//! A one-sided stop: the point of marker I against the plane through marker J across its axis.
//!
//! `F_I = f e` with the axis `e` of J, `f` of [`Impact`] at the penetration `-e.d` and its rate
//! `-e.V`, `d = r_I - r_J`, `V = v_I - v_J - w_J x d`. The force acts at the point, so that
//! `T_I = rho_I x F_I` and `T_J = -(r_I - p_J) x F_I`. The machine has none: what its arcs do to a
//! cylinder is locally this, worked out for the whole chain in [`crate::model`]. Here the contract of
//! all elements is put to a one-sided law.
use super::bushing::{LinkLoad, LinkTangent, Marker};
use super::{ForceElement, impact::Impact};
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;

/// A stop by its contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Law of the contact.
    pub law: Impact,
}

/// What the load depends on, or a small change of it.
#[derive(Clone, Copy, Default)]
struct Geometry {
    /// Arm of the point on I, and its arm from J's reference point \[m\].
    arms: [V3; 2],
    /// Axis of J.
    e: V3,
    /// From J's marker to the point \[m\].
    d: V3,
    /// Velocity of the point relative to J's frame [m/s].
    V: V3,
}

impl Geometry {
    fn new(i: &Marker, j: &Marker) -> Self {
        let d = i.p + i.rho - j.p - j.rho;
        Self {
            arms: [i.rho, d + j.rho],
            e: j.R.column(0).into_owned(),
            d,
            V: i.v + i.w.cross(&i.rho) - j.v - j.w.cross(&j.rho) - j.w.cross(&d),
        }
    }

    /// Change by the motion of I: its displacement, velocity, rotation and angular velocity.
    fn by_i([p, v, a, w]: [V3; 4], i: &Marker, j: &Marker) -> Self {
        let arm = a.cross(&i.rho);
        let d = p + arm;
        Self {
            arms: [arm, d],
            e: V3::zeros(),
            d,
            V: v + w.cross(&i.rho) + i.w.cross(&arm) - j.w.cross(&d),
        }
    }

    /// The same by the motion of J.
    fn by_j([p, v, a, w]: [V3; 4], at: &Self, j: &Marker) -> Self {
        let arm = a.cross(&j.rho);
        let d = -p - arm;
        Self {
            arms: [V3::zeros(), -p],
            e: a.cross(&at.e),
            d,
            V: -v - w.cross(&(j.rho + at.d)) - j.w.cross(&(arm + d)),
        }
    }

    fn depth(&self) -> f64 {
        -self.e.dot(&self.d)
    }

    fn rate(&self) -> f64 {
        -self.e.dot(&self.V)
    }
}

impl Stop {
    /// Changes of force, torque on I and torque on J.
    fn varied(&self, at: &Geometry, by: &Geometry) -> [V3; 3] {
        let law = self.law.force(at.depth(), at.rate());
        let depth = -by.e.dot(&at.d) - at.e.dot(&by.d);
        let rate = -by.e.dot(&at.V) - at.e.dot(&by.V);
        let force = at.e * law.force;
        let change = at.e * (law.by_penetration * depth + law.by_rate * rate) + by.e * law.force;
        [
            change,
            by.arms[0].cross(&force) + at.arms[0].cross(&change),
            -by.arms[1].cross(&force) - at.arms[1].cross(&change),
        ]
    }
}

impl ForceElement for Stop {
    fn load(&self, i: &Marker, j: &Marker) -> LinkLoad {
        let at = Geometry::new(i, j);
        let law = self.law.force(at.depth(), at.rate());
        let force = at.e * law.force;
        LinkLoad {
            force,
            torque_i: at.arms[0].cross(&force),
            torque_j: -at.arms[1].cross(&force),
            axial: law.force,
            dissipated: law.dissipated,
        }
    }

    fn tangent(&self, i: &Marker, j: &Marker, _: &LinkLoad) -> [LinkTangent; 2] {
        let at = Geometry::new(i, j);
        let fill = |by: &dyn Fn([V3; 4]) -> Geometry| {
            let mut parts = [[Matrix3::zeros(); 3]; 4];
            for (kind, part) in parts.iter_mut().enumerate() {
                for k in 0..3 {
                    let mut unit = [V3::zeros(); 4];
                    unit[kind][k] = 1.0;
                    let change = self.varied(&at, &by(unit));
                    for (matrix, column) in part.iter_mut().zip(change) {
                        matrix.set_column(k, &column);
                    }
                }
            }
            let [p, v, a, w] = parts;
            LinkTangent { p, v, a, w }
        };
        [
            fill(&|unit| Geometry::by_i(unit, i, j)),
            fill(&|unit| Geometry::by_j(unit, &at, j)),
        ]
    }

    fn energy(&self, i: &Marker, j: &Marker) -> f64 {
        self.law.energy(Geometry::new(i, j).depth())
    }
}
