//! Overload criteria that follow from the rope tension alone, whatever the shape of the ropes.
use super::guess::rigid_position;
use crate::drive::DriveState;
use crate::element::law::ForceLaw as _;
use crate::math::elementary::sin_cos;
use crate::model::kinematics::DoesNotClose;
use crate::model::{Machine, Ropes};
use crate::verdict::{Failure, Limits};
use std::f64::consts::PI;

/// Static tensions and free lengths of the back and the front rope of the inextensible machine under a drive.
pub(super) struct StaticTension {
    /// Tension of the back and of the front rope \[N\]; the sum for twin ropes.
    pub(super) tension: [f64; 2],
    /// Length of the back and of the front rope that does not lie on the arc \[m\].
    pub(super) span: [f64; 2],
}

impl StaticTension {
    /// Computes tensions and free lengths.
    ///
    /// # Errors
    /// [`DoesNotClose`] if the mechanism cannot be closed.
    pub(super) fn new(machine: &Machine, drive: &DriveState) -> Result<Self, DoesNotClose> {
        let d = &machine.description;
        let pull = drive.load + d.suspension_mass * d.gravity;
        let rigid = rigid_position(machine, drive.pin_angle)?;
        let moment = pull * d.front_arc.radius + d.beam_moment(sin_cos(rigid.beam));
        let leave = [rigid.tangent, -rigid.beam];
        let ropes = [(&d.back_arc, d.rope.back), (&d.front_arc, d.rope.front)];
        let span = [0, 1].map(|rope| {
            let (arc, count) = ropes[rope];
            let length = count as f64 * d.rope.pitch;
            (length - arc.radius * (arc.anchor - leave[rope]).abs()).max(d.rope.pitch)
        });
        Ok(Self {
            tension: [moment / rigid.arm, pull],
            span,
        })
    }
}

/// Returns the failure of ropes that cannot carry the load whatever their shape, with the share of the load
/// at which they fail. The tension follows from the load and the lever arms alone, so stretch, line load and
/// the stability of the cylinders are known before any equilibrium is sought.
///
/// If all cylinders of pitch `p` under a tension `T` rotate by the same small angle, the tension does work
/// proportional to `T p` and the shear of the joints stores energy proportional to `k2 p^2`: for `k2 p < T` a
/// straight rope buckles laterally, cylinder by cylinder. In a span of `n` cylinders, bending adds a
/// resistance of at most `k5 (pi / n)^2`.
pub fn overload(
    machine: &Machine,
    ropes: &Ropes,
    drive: &DriveState,
    limits: &Limits,
) -> Option<(Failure, f64)> {
    let StaticTension { tension, span } = StaticTension::new(machine, drive).ok()?;
    // of two ropes one carries half or more
    let tension = tension.map(|tension| tension * machine.rope_share());
    let d = &machine.description;
    let pitch = d.rope.pitch;
    let tightest = tension[0].max(tension[1]);
    let carried = ropes.joint.tension_at(limits.extension * pitch) / tightest;
    if carried < 1.0 {
        return Some((Failure::OverstretchedRope, carried.max(0.0)));
    }
    let line = (0..2)
        .map(|rope| tension[rope] * pitch / [d.back_arc, d.front_arc][rope].radius)
        .fold(0.0, f64::max);
    let carried = ropes.contact.response([limits.penetration], [0.0]).force[0] / line;
    if carried < 1.0 {
        return Some((Failure::RopeThroughHead, carried.max(0.0)));
    }
    let carried = (0..2)
        .map(|chain| {
            let turn = PI * pitch / span[chain];
            let bend = ropes.joint.rotational_stiffness[1] * turn * turn;
            (ropes.joint.stiffness[1] * pitch + bend / pitch) / tension[chain]
        })
        .fold(f64::INFINITY, f64::min);
    (carried < 1.0).then_some((Failure::TumbledCylinder, carried.max(0.0)))
}
