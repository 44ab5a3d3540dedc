//! Who holds the machine's two rope chains: rod or suspension point at the base (revolute), the
//! heads at the other end.
use crate::drive::DriveState;
use crate::element::bushing::Marker;
use crate::math::elementary::sin_cos;
use crate::model::chain::{Held, Joints};
use crate::model::description::Arc;
use crate::model::{Machine, Ropes};
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// The arc that a chain wraps.
    pub(crate) const fn arc(&self, chain: usize) -> &Arc {
        if chain == 0 {
            &self.description.back_arc
        } else {
            &self.description.front_arc
        }
    }

    /// The joints of a chain at an instant.
    pub(crate) fn joints<'a>(&'a self, chain: usize, at: &Instant<'a>) -> Joints<'a> {
        Joints {
            inner: &at.ropes.joint,
            base: Some(Held {
                marker: self.base_marker(chain, at),
                law: &at.ropes.base,
            }),
            head: Some(Held {
                marker: self.anchor_marker(chain, at),
                law: &at.ropes.anchor,
            }),
            axial: {
                let pitch = self.description.rope.pitch;
                let stiffness = at.ropes.joint.stiffness[0] * pitch;
                self.hooks.axial(chain, at.drive, stiffness, pitch)
            },
        }
    }

    /// The joint on the crossbeam end of the rod, or on the suspension point.
    fn base_marker(&self, chain: usize, at: &Instant<'_>) -> Marker {
        let (q, v) = (at.q, at.v);
        if chain == 0 {
            let rod = self.layout.rod();
            let (s, c) = sin_cos(q[rod]);
            let [pin, pin_velocity, _] = at.drive.pin;
            return Marker {
                p: V3::new(pin.x, pin.y, 0.0),
                rho: V3::new(c, s, 0.0) * self.description.rod.length,
                v: V3::new(pin_velocity.x, pin_velocity.y, 0.0),
                w: V3::new(0.0, 0.0, v[rod]),
                R: turned(s, c),
            };
        }
        let height = self.layout.suspension();
        Marker {
            p: V3::new(self.suspension_x, q[height], 0.0),
            rho: V3::zeros(),
            v: V3::new(0.0, v[height], 0.0),
            w: V3::zeros(),
            R: turned(1.0, 0.0),
        }
    }

    /// The fixed end of a rope on its head. The reference point carries the head's deflection, so
    /// that the arm stays rigid.
    pub(crate) fn anchor_marker(&self, chain: usize, at: &Instant<'_>) -> Marker {
        let beam = self.layout.beam();
        let (theta, rate) = (at.q[beam], at.v[beam]);
        let arc = self.arc(chain);
        let (s, c) = sin_cos(arc.anchor);
        let place = V3::new(
            arc.center[0] + arc.radius * c,
            arc.center[1] + arc.radius * s,
            0.0,
        );
        let (sb, cb) = sin_cos(theta);
        let R = turned(sb, cb);
        let w = V3::new(0.0, 0.0, rate);
        let (mut p, mut v) = (V3::zeros(), V3::zeros());
        if chain == 0 {
            for (k, shape) in self.anchor_shape.iter().enumerate() {
                let direction = R * V3::new(shape[0], shape[1], 0.0);
                p += direction * at.q[self.layout.mode(k)];
                v += direction * at.v[self.layout.mode(k)];
            }
            v += w.cross(&p);
        }
        // the rope's axis: towards the anchor along the arc
        let (sa, ca) = sin_cos(arc.anchor + theta);
        let (st, ct) = (arc.sense * ca, -arc.sense * sa);
        Marker {
            p,
            rho: R * place,
            v,
            w,
            R: turned(st, ct),
        }
    }
}

/// An individual's machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// The individual's ropes.
    pub ropes: &'a Ropes,
    /// Crank and load.
    pub drive: &'a DriveState,
    /// Coordinates.
    pub q: &'a [f64],
    /// Their rates.
    pub v: &'a [f64],
}

/// Rotation about z whose x axis is `(cosine, sine)`.
pub(crate) fn turned(sine: f64, cosine: f64) -> M3 {
    M3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0)
}
