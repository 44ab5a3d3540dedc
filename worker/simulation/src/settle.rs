//! Static equilibrium at a fixed crank: a geometric guess, then minimisation of the potential, and, if that
//! fails, a continuation from a compliant machine.
//!
//! A verdict must depend neither on the start nor on the damping. Loads that no equilibrium can carry are
//! detected before the search ([`overload`]); limits are checked at equilibria only; and an equilibrium that
//! the minimisation misses is found by the continuation, whose path depends on the individual alone.
mod beam_frequency;
mod continuation;
mod feasibility;
mod guess;
mod minimize;

use crate::model::RopeMachine;
use crate::system::{StateRef, System};
use crate::verdict::{Failure, Limits};

pub use beam_frequency::swing_rate;
pub use continuation::follow;
pub use feasibility::overload;
pub use guess::guess;
pub use minimize::{Damping, minimize, minimize_within};

/// Maximum number of iterations of the minimisation that is tried before the continuation.
const DIRECT: u32 = 50;
/// Number of iterations (factorisations) after which a search for one equilibrium starts no further step. It
/// covers the minimisation from a given start, the one from the geometric guess, and the continuation, whose
/// last step is completed.
pub const BUDGET: u64 = 2 * DIRECT as u64 + continuation::BUDGET + 100;

/// Solves the equilibrium of a machine at time 0 and checks it against the limits.
///
/// `start` is an initial guess that may save iterations, or `None` for the geometric guess; if it does not
/// lead to an equilibrium, the geometric guess and then the continuation are used.
///
/// # Errors
/// The limit that the equilibrium violates, or [`Failure::Budget`] if none was found.
pub fn equilibrium(
    system: &mut System<RopeMachine<'_>>,
    limits: &Limits,
    swing: [f64; 2],
    damping: &Damping,
    start: Option<&[f64]>,
) -> Result<Vec<f64>, Failure> {
    let Some(q) = search(system, damping, start) else {
        return Err(Failure::Budget);
    };
    let still = vec![0.0; q.len()];
    let mut force = vec![0.0; q.len()];
    let at = StateRef::new(0.0, &q, &still);
    let loads = system.forces(at, &mut force);
    let broken = limits.first_exceeded(loads.equations(), &q, swing);
    broken.map_or(Ok(q), Err)
}

fn search(
    system: &mut System<RopeMachine<'_>>,
    damping: &Damping,
    start: Option<&[f64]>,
) -> Option<Vec<f64>> {
    if let Some(start) = start {
        let mut q = start.to_vec();
        if minimize_within(system, 0.0, &mut q, damping, DIRECT) {
            return Some(q);
        }
    }
    let drive = system.equations.drive_state(0.0);
    let RopeMachine { machine, ropes, .. } = system.equations;
    if let Ok(mut q) = guess(machine, &ropes, &drive)
        && minimize_within(system, 0.0, &mut q, damping, DIRECT)
    {
        return Some(q);
    }
    let mut q = vec![0.0; machine.layout.len()];
    follow(system, &mut q).then_some(q)
}
