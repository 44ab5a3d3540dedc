//! Static equilibrium at a fixed crank: a geometric guess, then minimisation of the potential, and
//! where that gets lost a continuation from a compliant machine.
//!
//! Neither start nor damping may decide a verdict. What no equilibrium can carry is known before one
//! is sought ([`overload`]); limits are checked at equilibria alone; and an equilibrium that the
//! minimisation misses is found by the continuation, whose path is the individual's own.
mod continuation;
mod guess;
mod minimize;
mod overload;
mod swing;

use crate::model::Individual;
use crate::system::{StateRef, System};
use crate::verdict::{Failure, Limits};

pub use continuation::follow;
pub use guess::guess;
pub use minimize::{Damping, minimize, minimize_within};
pub use overload::overload;
pub use swing::swing_rate;

/// Iterations that a minimisation gets before the continuation takes over.
const DIRECT: u32 = 50;
/// Iterations (factorisations) after which a search for one equilibrium begins no further step: from
/// a given start, from the geometric guess, and along the continuation, whose last step is finished.
pub const BUDGET: u64 = 2 * DIRECT as u64 + continuation::BUDGET + 100;

/// Equilibrium of a machine at time 0, and whether it keeps inside the limits.
///
/// `q` is a start that may save iterations, or `None` for the geometric guess; where the start
/// misleads, the guess and then the continuation decide.
///
/// # Errors
/// The limit that the equilibrium breaks, or [`Failure::Budget`] where none was found.
pub fn equilibrium(
    system: &mut System<Individual<'_>>,
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
    let broken = limits.broken(loads.equations(), &q, swing);
    broken.map_or(Ok(q), Err)
}

fn search(
    system: &mut System<Individual<'_>>,
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
    let Individual { machine, ropes, .. } = system.equations;
    if let Ok(mut q) = guess(machine, &ropes, &drive)
        && minimize_within(system, 0.0, &mut q, damping, DIRECT)
    {
        return Some(q);
    }
    let mut q = vec![0.0; machine.layout.len()];
    follow(system, &mut q).then_some(q)
}
