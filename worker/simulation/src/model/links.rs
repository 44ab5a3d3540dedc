//! End supports of the rope chains: rod or suspension point at the base (revolute joint), the heads at the
//! other end.
use crate::element::bushing::Marker;
use crate::math::elementary::sin_cos;
use crate::math::rotation::{about_z, skew};
use crate::model::chain::parts::{EndJoint, Joints};
use crate::model::description::Arc;
use crate::model::extension::Extensions;
use crate::model::extension::axial::{AxialLaws, RopeProperties};
use crate::model::machine::Machine;
use crate::model::machine_state::MachineState;
use crate::model::parallel_ropes::{BACK, HeadResponse, ParallelRope};
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Returns the arc around which a chain wraps.
    pub(crate) fn arc(&self, chain: usize) -> &Arc {
        if self.strands[chain].rope == BACK {
            &self.description.back_arc
        } else {
            &self.description.front_arc
        }
    }

    /// Returns the joints of a chain at an instant: inner joints, both end joints, and the axial laws of
    /// effects.
    pub(crate) fn joints<'a>(&'a self, chain: usize, at: &MachineState<'a>) -> Joints<'a> {
        Joints {
            inner: &at.ropes.joint,
            base: Some(EndJoint {
                marker: self.base_marker(&self.strands[chain], at),
                law: &at.ropes.base,
                pinned: self.layout.twins(),
            }),
            head: Some(EndJoint {
                marker: self.anchor_marker(chain, at),
                law: &at.ropes.anchor,
                pinned: false,
            }),
            axial: self.axial(&self.extensions, chain, at),
        }
    }

    /// Returns the axial laws that effects have added to a chain; `None` if there are none.
    pub(crate) fn axial<'a>(
        &self,
        extensions: &'a Extensions,
        chain: usize,
        at: &MachineState<'a>,
    ) -> Option<AxialLaws<'a>> {
        let pitch = self.description.rope.pitch;
        let share = self.rope_share();
        // laws along a rope are of the pair, as its coefficients are
        let carrier = RopeProperties {
            stiffness: at.ropes.joint.stiffness[0] * pitch / share,
            share,
            length: pitch,
        };
        extensions.axial(self.strands[chain].rope, at.drive, carrier)
    }

    /// Returns the attachment point (marker) of a chain's base joint, on the crossbeam end of the rod or at
    /// the suspension point.
    fn base_marker(&self, strand: &ParallelRope, at: &MachineState<'_>) -> Marker {
        let (q, v) = (at.q, at.v);
        if strand.rope == BACK {
            let rod = self.layout.rod();
            let (s, c) = sin_cos(q[rod]);
            let [pin, pin_velocity, _] = at.drive.pin;
            let along = V3::new(c, s, 0.0) * (self.description.rod.length + strand.excess_length);
            return Marker {
                p: V3::new(pin.x, pin.y, 0.0),
                rho: along + V3::new(0.0, 0.0, strand.z),
                v: V3::new(pin_velocity.x, pin_velocity.y, 0.0),
                w: V3::new(0.0, 0.0, v[rod]),
                R: about_z(s, c),
            };
        }
        let height = self.layout.suspension();
        Marker {
            p: V3::new(self.suspension_x, q[height], 0.0),
            rho: V3::new(0.0, strand.excess_length, strand.z),
            v: V3::new(0.0, v[height], 0.0),
            w: V3::zeros(),
            R: about_z(1.0, 0.0),
        }
    }

    /// Returns the marker of the fixed end of a rope on its head.
    ///
    /// The reference point includes the head's deflection, so that the arm remains rigid. If the end also
    /// rotates with the head ([`EndRotation`]), the reference point is the end itself, so that it rotates in
    /// place.
    pub(crate) fn anchor_marker(&self, chain: usize, at: &MachineState<'_>) -> Marker {
        let beam = self.layout.beam();
        let (theta, rate) = (at.q[beam], at.v[beam]);
        let arc = self.arc(chain);
        let (s, c) = sin_cos(arc.anchor);
        let place = V3::new(
            arc.center[0] + arc.radius * c,
            arc.center[1] + arc.radius * s,
            self.strands[chain].z,
        );
        let (sb, cb) = sin_cos(theta);
        let R = about_z(sb, cb);
        let w = V3::new(0.0, 0.0, rate);
        let (mut p, mut v) = (V3::zeros(), V3::zeros());
        let face = self.faces.get(chain);
        for (k, shape) in face.iter().flat_map(|face| face.anchor.iter().enumerate()) {
            let direction = R * V3::from(shape.moves);
            p += direction * at.q[self.layout.mode(k)];
            v += direction * at.v[self.layout.mode(k)];
        }
        // the rope's axis: towards the anchor along the arc
        let (sa, ca) = sin_cos(arc.anchor + theta);
        let (st, ct) = (arc.sense * ca, -arc.sense * sa);
        let mut marker = Marker {
            p,
            rho: R * place,
            v,
            w,
            R: about_z(st, ct),
        };
        if let Some(turn) = face.and_then(|face| self.end_rotation(face, arc.anchor, at)) {
            marker.p += marker.rho;
            marker.rho = V3::zeros();
            marker.R = turn.rotation() * marker.R;
            marker.w += turn.velocity();
        }
        if face.is_some() {
            marker.v += w.cross(&marker.p);
        }
        marker
    }

    /// Returns the rotation of a rope's fixed end caused by the head's modes; `None` for a single rope, whose
    /// end does not rotate.
    pub(crate) fn end_rotation(
        &self,
        face: &HeadResponse,
        anchor: f64,
        at: &MachineState<'_>,
    ) -> Option<EndRotation> {
        face.beside?;
        let (mut angles, mut rates) = ([0.0; 2], [0.0; 2]);
        for (k, shape) in face.anchor.iter().enumerate() {
            for (axis, turns) in shape.turns.iter().enumerate() {
                angles[axis] += turns * at.q[self.layout.mode(k)];
                rates[axis] += turns * at.v[self.layout.mode(k)];
            }
        }
        let (s, c) = sin_cos(anchor + at.q[self.layout.beam()]);
        Some(EndRotation {
            tangent: V3::new(-s, c, 0.0),
            radial: V3::new(c, s, 0.0),
            angles,
            rates,
        })
    }
}

/// Rotation of a rope's fixed end caused by the head's modes, in the world frame W: first about the radius,
/// then about the tangent of the arc, both axes rotating with the beam.
pub(crate) struct EndRotation {
    tangent: V3,
    radial: V3,
    /// Rotation angles of the rope's end about the tangent and about the radius of the arc \[rad\].
    angles: [f64; 2],
    rates: [f64; 2],
}

impl EndRotation {
    /// Returns the rotation matrix `R_t R_r` of the rope's end: about the tangent `t` after about the radius
    /// `r`.
    fn rotation(&self) -> M3 {
        let about = |axis: &V3, angle: f64| {
            let (s, c) = sin_cos(angle);
            M3::identity() * c + skew(axis) * s + axis * axis.transpose() * (1.0 - c)
        };
        about(&self.tangent, self.angles[0]) * about(&self.radial, self.angles[1])
    }

    /// Returns the axes about which the end's two angles rotate it: the tangent `t`, and the rotated radius
    /// `R_t r`.
    pub(crate) fn axes(&self) -> [V3; 2] {
        let (s, c) = sin_cos(self.angles[0]);
        [self.tangent, self.radial * c - V3::z() * s]
    }

    /// Returns the angular velocity of the rope's end due to the rates of its two rotation angles [rad/s].
    pub(crate) fn velocity(&self) -> V3 {
        let [t, r] = self.axes();
        t * self.rates[0] + r * self.rates[1]
    }

    /// Returns the derivative of the second rotation axis (the rotated radius) with respect to the first
    /// angle (about the tangent).
    pub(crate) fn axis_by_tilt(&self) -> V3 {
        let (s, c) = sin_cos(self.angles[0]);
        -self.radial * s - V3::z() * c
    }

    /// Returns the rate of the second rotation angle, about the radius [rad/s].
    pub(crate) const fn second_rate(&self) -> f64 {
        self.rates[1]
    }
}
