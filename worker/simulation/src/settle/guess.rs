//! Geometric estimate of the equilibrium of a taut machine: stretched ropes on the arcs, with the penetration
//! that their line load causes. The shorter of two ropes carries additional stretch equal to the difference
//! in length.
use crate::drive::DriveState;
use crate::math::elementary::sin_cos;
use crate::model::chain::Chain;
use crate::model::kinematics::{DoesNotClose, Position};
use crate::model::layout::Motion;
use crate::model::parallel_ropes::{BACK, FRONT};
use crate::model::{Machine, Ropes};

/// Estimates coordinates near equilibrium: taut, stretched ropes on the arcs, with the penetration that their
/// line load causes.
///
/// # Errors
/// [`DoesNotClose`] if the mechanism with the stretched rope cannot be closed.
pub fn guess(
    machine: &Machine,
    ropes: &Ropes,
    drive: &DriveState,
) -> Result<Vec<f64>, DoesNotClose> {
    let d = &machine.description;
    let layout = machine.layout;
    let pull = drive.load + d.suspension_mass * d.gravity;
    let rigid = rigid_position(machine, drive.pin_angle)?;
    let share = machine.rope_share();
    let front = TautRope::new(machine, ropes, FRONT, pull * share);
    let lever = pull * d.front_arc.radius + d.beam_moment(sin_cos(rigid.beam));
    let back = TautRope::new(machine, ropes, BACK, lever / rigid.arm * share);
    let pitches = |count: usize| count as f64 - 1.0 + 2.0 * d.rope.end_pitches;
    let mechanism = machine.mechanism(
        back.radius,
        machine.back_length() + back.extension * pitches(d.rope.back),
    );
    let position = mechanism.position(drive.pin_angle, rigid.beam, rigid.tangent)?;

    let mut q = vec![0.0; layout.len()];
    q[layout.beam()] = position.beam;
    let (s, c) = sin_cos(position.beam);
    let [x, y] = d.back_arc.center;
    let center = [c * x - s * y, s * x + c * y];
    let leave = position.beam + position.tangent;
    let (s, c) = sin_cos(leave);
    // the rod points along the straight rope, towards the head: -t at the tangent point
    q[layout.rod()] = crate::math::elementary::atan2(-c, s);
    let mut end = 0.0;
    for (chain, strand) in machine.strands.iter().enumerate() {
        let (taut, center, anchor, leave) = if strand.rope == BACK {
            (back, center, d.back_arc.anchor, leave)
        } else {
            (front, [0.0; 2], d.front_arc.anchor, 0.0)
        };
        let count = machine.chains[chain].count;
        let own = taut.longer(strand.excess_length / pitches(count));
        let tip = own.place(
            machine,
            chain,
            center,
            [anchor + position.beam, leave],
            &mut q,
        );
        if strand.rope == FRONT {
            end += share * tip;
        }
    }
    q[layout.suspension()] = end;
    Ok(q)
}

/// Solves the position of the inextensible mechanism at a pin angle, tracked from bottom dead centre.
pub(super) fn rigid_position(machine: &Machine, pin: f64) -> Result<Position, DoesNotClose> {
    let mechanism = machine.mechanism(machine.description.back_arc.radius, machine.back_length());
    let mut at = machine.bottom;
    let steps = 24;
    for k in 1..=steps {
        let angle =
            machine.bottom.pin + (pin - machine.bottom.pin) * f64::from(k) / f64::from(steps);
        at = mechanism.position(angle, at.beam, at.tangent)?;
    }
    Ok(at)
}

/// Rope under a tension: its radius on the arc and the extension of its joints.
#[derive(Clone, Copy)]
struct TautRope {
    radius: f64,
    extension: f64,
    /// Extension at zero tension \[m\]; negative for a preloaded joint.
    slack: f64,
}

impl TautRope {
    fn new(machine: &Machine, ropes: &Ropes, rope: usize, tension: f64) -> Self {
        let d = &machine.description;
        let pitch = d.rope.pitch;
        let radius = [d.back_arc, d.front_arc][rope].radius;
        let joint = &ropes.joint;
        let slack = joint.extension_under(0.0).max(-0.5 * pitch);
        let depth = ropes
            .contact
            .depth_under(tension * pitch / radius)
            .min(0.05);
        Self {
            radius: radius - depth,
            extension: joint.extension_under(tension).min(0.5 * pitch).max(slack),
            slack,
        }
    }

    /// Returns the same rope with a greater unstretched length: the extension of every joint is reduced by
    /// `by` \[m\].
    fn longer(self, by: f64) -> Self {
        Self {
            extension: (self.extension - by).max(self.slack),
            ..self
        }
    }

    /// Writes the coordinates of the cylinders from the anchor (first angle) along the arc to the point where
    /// the rope leaves it (second angle) and on along the tangent; returns the height of the rope's free end.
    fn place(
        &self,
        machine: &Machine,
        chain: usize,
        center: [f64; 2],
        [anchor, leave]: [f64; 2],
        q: &mut [f64],
    ) -> f64 {
        let pitch = machine.description.rope.pitch;
        let Chain { first, count, .. } = machine.chains[chain];
        let width = machine.layout.motion.width();
        let sense = machine.arc(chain).sense;
        let wrapped = self.radius * (anchor - leave).abs();
        let end = self.extension * machine.description.rope.end_pitches;
        let mut along = end + 0.5 * pitch;
        for j in (0..count).rev() {
            let angle = if along < wrapped {
                anchor - sense * along / self.radius
            } else {
                leave
            };
            let (s, c) = sin_cos(angle);
            let straight = (along - wrapped).max(0.0);
            // towards the anchor the rope runs along sense * t
            let (tx, ty) = (-sense * s, sense * c);
            let at = (first + j) * width;
            q[at] = center[0] + self.radius * c - straight * tx;
            q[at + 1] = center[1] + self.radius * s - straight * ty;
            if machine.layout.motion == Motion::Space {
                q[at + 2] = machine.strands[chain].z;
            }
            q[at + width - 1] = crate::math::elementary::atan2(ty, tx);
            along += pitch + self.extension;
        }
        let (s, c) = sin_cos(leave);
        let tip = along - 0.5 * pitch - self.extension + end - wrapped;
        center[1] + self.radius * s - tip * sense * c
    }
}
