//! Static equilibrium at a fixed crank: a geometric guess, then minimisation of the potential.
//!
//! The minimisation is a damped Newton method that only ever accepts a lower potential, so the
//! answer is a stable equilibrium and no transient can decide a verdict. Limits are checked at
//! equilibria alone.
use crate::drive::DriveState;
use crate::math::elementary::sin_cos;
use crate::model::chain::Chain;
use crate::model::kinematics::{DoesNotClose, Position};
use crate::model::{Individual, Machine, Ropes};
use crate::system::{Static, System};
use crate::verdict::{Failure, Limits};

/// Iterations (factorisations) that one equilibrium may take.
pub const BUDGET: u32 = 150;

/// Coordinates near equilibrium: taut, stretched ropes on the arcs, sunk in as far as their line
/// load asks for.
///
/// # Errors
/// [`DoesNotClose`] when the stretched rope no longer reaches.
pub fn guess(
    machine: &Machine,
    ropes: &Ropes,
    drive: &DriveState,
) -> Result<Vec<f64>, DoesNotClose> {
    let d = &machine.description;
    let layout = machine.layout;
    let pull = drive.load + d.suspension_mass * d.gravity;
    let rigid = rigid_position(machine, drive.pin_angle)?;
    let front = Strand::new(machine, ropes, 1, pull);
    let lever = pull * d.front_arc.radius + d.beam_gravity_moment * sin_cos(rigid.beam).1;
    let back = Strand::new(machine, ropes, 0, lever / rigid.arm);
    let mechanism = machine.mechanism(
        back.radius,
        machine.back_length()
            + back.extension * (d.rope.back as f64 - 1.0 + 2.0 * d.rope.end_pitches),
    );
    let position = mechanism.position(drive.pin_angle, rigid.beam, rigid.tangent)?;

    let mut q = vec![0.0; layout.len()];
    q[layout.beam()] = position.beam;
    let (s, c) = sin_cos(position.beam);
    let [x, y] = d.back_arc.center;
    let center = [c * x - s * y, s * x + c * y];
    let leave = position.beam + position.tangent;
    back.place(
        machine,
        0,
        center,
        [d.back_arc.anchor + position.beam, leave],
        &mut q,
    );
    let (s, c) = sin_cos(leave);
    // the rod points along the straight rope, towards the head: -t at the tangent point
    q[layout.rod()] = crate::math::elementary::atan2(-c, s);
    let end = front.place(
        machine,
        1,
        [0.0; 2],
        [d.front_arc.anchor + position.beam, 0.0],
        &mut q,
    );
    q[layout.suspension()] = end;
    Ok(q)
}

/// What the ropes cannot carry whatever their shape, with the share of the load at which they give
/// in: the tension follows from the load and the arms alone, so stretch and line load are known
/// before any equilibrium is sought.
pub fn overload(
    machine: &Machine,
    ropes: &Ropes,
    drive: &DriveState,
    limits: &Limits,
) -> Option<(Failure, f64)> {
    let d = &machine.description;
    let pull = drive.load + d.suspension_mass * d.gravity;
    let rigid = rigid_position(machine, drive.pin_angle).ok()?;
    let tension = [
        (pull * d.front_arc.radius + d.beam_gravity_moment * sin_cos(rigid.beam).1) / rigid.arm,
        pull,
    ];
    let pitch = d.rope.pitch;
    let tightest = tension[0].max(tension[1]);
    let carried = limits.extension * pitch * ropes.joint.stiffness[0] / tightest;
    if carried < 1.0 {
        return Some((Failure::OverstretchedRope, carried.max(0.0)));
    }
    let line = (0..2)
        .map(|chain| tension[chain] * pitch / machine.arc(chain).radius)
        .fold(0.0, f64::max);
    let carried = ropes.contact.force(limits.penetration, 0.0).force / line;
    (carried < 1.0).then_some((Failure::RopeThroughHead, carried.max(0.0)))
}

/// The inextensible position at a pin angle, followed from bottom dead centre.
fn rigid_position(machine: &Machine, pin: f64) -> Result<Position, DoesNotClose> {
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

/// One rope under a tension.
struct Strand {
    radius: f64,
    extension: f64,
}

impl Strand {
    fn new(machine: &Machine, ropes: &Ropes, chain: usize, tension: f64) -> Self {
        let pitch = machine.description.rope.pitch;
        let radius = machine.arc(chain).radius;
        let depth = ropes
            .contact
            .depth_under(tension * pitch / radius)
            .min(0.05);
        Self {
            radius: radius - depth,
            extension: (tension / ropes.joint.stiffness[0]).clamp(0.0, 0.5 * pitch),
        }
    }

    /// Places cylinders from the anchor (first angle) over the arc to where the rope leaves it
    /// (second angle) and on along the tangent; returns the height of the rope's free end.
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
            q[at + width - 1] = crate::math::elementary::atan2(ty, tx);
            along += pitch + self.extension;
        }
        let (s, c) = sin_cos(leave);
        let tip = along - 0.5 * pitch - self.extension + end - wrapped;
        center[1] + self.radius * s - tip * sense * c
    }
}

/// What a search for equilibrium found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// Converged, inside all limits.
    Equilibrium,
    /// Converged outside a limit, or not at all.
    Failed(Failure),
}

/// Equilibrium of a machine at time 0 from `q` on, and whether it keeps inside the limits.
pub fn equilibrium(
    system: &mut System<Individual<'_>>,
    limits: &Limits,
    swing: [f64; 2],
    q: &mut [f64],
) -> Settled {
    let converged = minimize(system, 0.0, q);
    let individual = &system.equations;
    let broken = limits.broken(
        individual.machine,
        individual.ropes.joint.stiffness[0],
        q,
        swing,
        &individual.scratch,
    );
    match broken {
        Some(kind) => Settled::Failed(kind),
        None if converged => Settled::Equilibrium,
        None => Settled::Failed(Failure::Budget),
    }
}

/// Minimises the potential at time `t` from `q` on; the loads of the last trial are at hand.
///
/// Whether a minimum was reached within the budget.
pub fn minimize<E: Static>(system: &mut System<E>, t: f64, q: &mut [f64]) -> bool {
    let n = q.len();
    let still = vec![0.0; n];
    let (mut force, mut step, mut trial) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    system.forces(t, q, &still, &mut force);
    let mut height = system.equations.potential(t, q, &still);
    let mut lambda = 0.0;
    for _ in 0..BUDGET {
        system.statistics.newton_iterations += 1;
        let solvable = system.factorize_static(t, (q, &still), lambda).is_ok();
        step.copy_from_slice(&force);
        if solvable {
            system.solve(&mut step);
        }
        let norm = system.equations.newton_norm(&step);
        let slope: f64 = force.iter().zip(&step).map(|(f, s)| f * s).sum();
        if !(solvable && norm.is_finite() && slope > 0.0) {
            if solvable && norm < CONVERGED {
                return true;
            }
            lambda = (lambda * 10.0).max(FIRST_DAMPING);
            if lambda > LAST_DAMPING {
                break;
            }
            system.forces(t, q, &still, &mut force);
            continue;
        }
        let factor = (LARGEST_STEP / norm).min(1.0);
        for i in 0..n {
            trial[i] = q[i] + factor * step[i];
        }
        system.forces(t, &trial, &still, &mut force);
        let next = system.equations.potential(t, &trial, &still);
        // near the minimum the decrease drowns in rounding: then the step itself must be small
        if next < height - 1e-4 * factor * slope
            || (norm < ROUNDING && next < height + 1e-9 * height.abs())
        {
            q.copy_from_slice(&trial);
            height = next;
            if lambda == 0.0 && norm < CONVERGED {
                return true;
            }
            lambda = if lambda <= FIRST_DAMPING {
                0.0
            } else {
                lambda * 0.1
            };
        } else {
            lambda = (lambda * 10.0).max(FIRST_DAMPING);
            if lambda > LAST_DAMPING {
                break;
            }
            system.forces(t, q, &still, &mut force);
        }
    }
    false
}

/// Damping [N/m] with which a failed step is tried again first, and beyond which none is tried.
const FIRST_DAMPING: f64 = 1e2;
const LAST_DAMPING: f64 = 1e14;
/// Longest step, and the step at which equilibrium is reached, in units of Newton's accuracy:
/// 0.05 m, and 2e-11 m.
const LARGEST_STEP: f64 = 2.5e4;
const CONVERGED: f64 = 1e-5;
const ROUNDING: f64 = 1.0;
