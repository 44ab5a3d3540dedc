//! Continuation of the equilibrium from a compliant machine, whose equilibrium is known, to the given one.
//!
//! A minimisation may fail although an equilibrium exists (a rope so stiff that it stands off its arc, so
//! that every lateral step stretches it). The ropes' coefficients are varied along a straight line in their
//! logarithms, from values for which the rope is taut, flexible and lies on its arc, to the given ones, and
//! the equilibrium is tracked by Newton's method. The path depends on the individual alone, not on a start or
//! a damping.
use super::feasibility::StaticTension;
use super::guess::guess;
use super::minimize::{CONVERGED, Damping, minimize, minimize_within};
use crate::math::elementary::powf;
use crate::model::{Machine, RopeMachine, Ropes};
use crate::system::{StateRef, Static, System};

/// Maximum number of iterations (factorisations) of a continuation.
pub(super) const BUDGET: u64 = 1200;

/// Solves the equilibrium of an individual at time 0 by continuation and writes its coordinates to `q`.
/// Returns whether it was reached.
pub fn follow(system: &mut System<RopeMachine<'_>>, q: &mut [f64]) -> bool {
    let target = system.equations.ropes;
    let reached = Path::new(system, &target).is_some_and(|path| path.walk(system, q));
    system.equations.ropes = target;
    reached
}

/// Continuation path of the ropes' coefficients from compliant values to those of the individual.
struct Path<'a> {
    machine: &'a Machine,
    from: Ropes,
    to: Ropes,
    start: Vec<f64>,
}

impl<'a> Path<'a> {
    /// Prepares the path; returns `None` if the mechanism does not close even with compliant ropes.
    fn new(system: &mut System<RopeMachine<'a>>, to: &Ropes) -> Option<Self> {
        let drive = system.equations.drive_state(0.0);
        let machine = system.equations.machine;
        let hanging = StaticTension::new(machine, &drive).ok()?;
        let tightest = hanging.tension[0].max(hanging.tension[1]);
        let from = compliant(machine, to, tightest * machine.rope_share());
        let start = guess(machine, &from, &drive).ok()?;
        Some(Self {
            machine,
            from,
            to: *to,
            start,
        })
    }

    /// Returns the rope coefficients at a position on the continuation path, from 0 (compliant) to 1 (given).
    fn at(&self, place: f64) -> Ropes {
        let mix = |a: f64, b: f64| powf(a, 1.0 - place) * powf(b, place);
        let pair = |a: [f64; 2], b: [f64; 2]| [mix(a[0], b[0]), mix(a[1], b[1])];
        let (a, b) = (&self.from, &self.to);
        let (mut joint, mut contact) = (b.joint, b.contact);
        joint.stiffness = pair(a.joint.stiffness, b.joint.stiffness);
        joint.rotational_stiffness =
            pair(a.joint.rotational_stiffness, b.joint.rotational_stiffness);
        contact.stiffness = mix(a.contact.stiffness, b.contact.stiffness);
        let machine = self.machine;
        Ropes::of(
            joint,
            contact,
            &machine.description.rope,
            machine.layout.ropes,
        )
    }

    fn walk(&self, system: &mut System<RopeMachine<'_>>, q: &mut [f64]) -> bool {
        let begun = system.statistics.newton_iterations;
        q.copy_from_slice(&self.start);
        system.equations.ropes = self.at(0.0);
        if !minimize(system, 0.0, q) {
            return false;
        }
        let (mut place, mut stride) = (0.0, FIRST_STRIDE);
        let mut last: Option<(f64, Vec<f64>)> = None;
        let mut trial = q.to_vec();
        while place < 1.0 {
            let next = f64::min(place + stride, 1.0);
            system.equations.ropes = if next < 1.0 { self.at(next) } else { self.to };
            trial.copy_from_slice(q);
            if let Some((before, of)) = &last {
                let ratio = (next - place) / (place - before);
                for ((trial, q), of) in trial.iter_mut().zip(&*q).zip(of) {
                    *trial += ratio * (q - of);
                }
            }
            let mut found = newton(system, &mut trial);
            if !found && stride < CAREFUL {
                trial.copy_from_slice(q);
                found = minimize_within(system, 0.0, &mut trial, &Damping::default(), PATIENCE);
            }
            if found {
                let (at, of) = last.get_or_insert_with(|| (0.0, q.to_vec()));
                *at = place;
                of.copy_from_slice(q);
                q.copy_from_slice(&trial);
                place = next;
                stride *= 2.0;
            } else {
                stride *= 0.35;
            }
            if stride < SHORTEST_STRIDE || system.statistics.newton_iterations - begun > BUDGET {
                return false;
            }
        }
        true
    }
}

/// Returns compliant ropes: a tension \[N\] extends a joint by a thousandth of its length and presses the
/// rope one millimetre into the tighter arc, and bending decays within 0.1 m.
fn compliant(machine: &Machine, to: &Ropes, tension: f64) -> Ropes {
    let pitch = machine.description.rope.pitch;
    let mut ropes = *to;
    let axial = tension / (1e-3 * pitch);
    ropes.joint.stiffness = [axial, 0.4 * axial];
    ropes.joint.rotational_stiffness = [tension * 1e-2 / pitch; 2];
    let d = &machine.description;
    let line = tension * pitch / d.back_arc.radius.min(d.front_arc.radius);
    ropes.contact.stiffness = line / powf(1e-3, to.contact.exponent);
    ropes
}

/// Solves an equilibrium by Newton's method with full steps up to a maximum length. A chain that moves
/// laterally stretches before it follows, so the step length may increase a limited number of times.
fn newton<E: Static>(system: &mut System<E>, q: &mut [f64]) -> bool {
    let still = vec![0.0; q.len()];
    let mut step = vec![0.0; q.len()];
    let (mut shortest, mut setbacks) = (f64::INFINITY, 0);
    while setbacks <= SETBACKS {
        system.statistics.newton_iterations += 1;
        let at = StateRef::new(0.0, q, &still);
        let mut loads = system.forces(at, &mut step);
        if loads.factorize_static(0.0).is_err() {
            return false;
        }
        loads.solve(&mut step);
        let norm = loads.equations().newton_norm(&step);
        if !norm.is_finite() || norm > LOST {
            return false;
        }
        if norm < 0.9 * shortest {
            shortest = norm;
        } else {
            setbacks += 1;
        }
        let factor = (LARGEST_STEP / norm).min(1.0);
        for (q, step) in q.iter_mut().zip(&step) {
            *q += factor * step;
        }
        if norm < CONVERGED {
            return true;
        }
    }
    false
}

const FIRST_STRIDE: f64 = 0.25;
const SHORTEST_STRIDE: f64 = 2e-3;
/// Step length on the continuation path below which a minimisation of at most [`PATIENCE`] iterations is
/// tried where Newton's method fails, because a cylinder snaps onto or off its arc there.
const CAREFUL: f64 = 0.02;
const PATIENCE: u32 = 40;
/// Maximum number of Newton steps of one solution that are not clearly shorter than all previous steps.
const SETBACKS: u32 = 3;
/// Maximum length of a Newton step, 0.2 m in units of Newton's tolerance. A step longer than [`LOST`] (20 m)
/// means that Newton's method has diverged.
const LARGEST_STEP: f64 = 1e5;
const LOST: f64 = 1e7;
