//! Minimisation of the potential from a start near the equilibrium.
use crate::system::{Loads, StateRef, Static, System};

/// Maximum number of iterations (factorisations) of a minimisation.
const BUDGET: u32 = 150;

/// Damping of the Newton steps of the minimisation, used where an undamped step would raise the potential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// Additional stiffness [N/m] with which a failed step is first repeated; results must not depend on it.
    pub first: f64,
    /// Largest additional stiffness [N/m], beyond which the minimisation fails; results must not depend on
    /// it.
    pub last: f64,
}

impl Default for Damping {
    fn default() -> Self {
        Self {
            first: 1e2,
            last: 1e14,
        }
    }
}

/// Minimises the potential at time `t`, starting from `q`, by a damped Newton method that accepts only
/// decreases of the potential. Returns whether a minimum was reached within the budget.
pub fn minimize<E: Static>(system: &mut System<E>, t: f64, q: &mut [f64]) -> bool {
    minimize_within(system, t, q, &Damping::default(), BUDGET)
}

/// Minimises the potential as [`minimize`] does, with a given damping and iteration budget.
pub fn minimize_within<E: Static>(
    system: &mut System<E>,
    t: f64,
    q: &mut [f64],
    damping: &Damping,
    budget: u32,
) -> bool {
    let n = q.len();
    let still = vec![0.0; n];
    let (mut force, mut step, mut trial) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut lambda = 0.0;
    let mut left = budget;
    let loads = system.forces(StateRef { t, q, v: &still }, &mut force);
    let mut height = loads.potential();
    // whether a further iteration's factor was made, and none where the budget is used up
    let mut factor_made = factorize(loads, lambda, &mut left);
    while let Some(solvable) = factor_made {
        step.copy_from_slice(&force);
        if solvable {
            system.solve(&mut step);
        }
        let norm = system.equations.newton_norm(&step);
        let slope: f64 = force.iter().zip(&step).map(|(f, s)| f * s).sum();
        let descends = solvable && norm.is_finite() && slope > 0.0;
        if descends {
            let factor = (LARGEST_STEP / norm).min(1.0);
            for i in 0..n {
                trial[i] = q[i] + factor * step[i];
            }
            let at = StateRef {
                t,
                q: &trial,
                v: &still,
            };
            let loads = system.forces(at, &mut force);
            let next = loads.potential();
            // near the minimum the decrease drowns in rounding: then the step itself must be small
            if next < height - 1e-4 * factor * slope
                || (norm < ROUNDING && next < height + 1e-9 * height.abs())
            {
                q.copy_from_slice(&trial);
                height = next;
                if lambda == 0.0 && norm < CONVERGED {
                    return true;
                }
                lambda = if lambda <= damping.first {
                    0.0
                } else {
                    lambda * 0.1
                };
                factor_made = factorize(loads, lambda, &mut left);
                continue;
            }
        } else if solvable && norm < CONVERGED {
            return true;
        }
        lambda = (lambda * 10.0).max(damping.first);
        if lambda > damping.last {
            break;
        }
        let loads = system.forces(StateRef { t, q, v: &still }, &mut force);
        factor_made = factorize(loads, lambda, &mut left);
    }
    false
}

/// Starts an iteration of the minimisation by factorising the damped stiffness matrix. Returns whether the
/// factorisation succeeded, or `None` if `left`, the number of iterations left, is zero.
fn factorize<E: Static>(mut loads: Loads<'_, '_, E>, lambda: f64, left: &mut u32) -> Option<bool> {
    *left = left.checked_sub(1)?;
    loads.statistics().newton_iterations += 1;
    Some(loads.factorize_static(lambda).is_ok())
}

/// Maximum length of a Newton step of the minimisation, 0.05 m in units of Newton's tolerance. After a step
/// shorter than [`CONVERGED`] (2e-11 m) equilibrium is reached.
const LARGEST_STEP: f64 = 2.5e4;
pub(super) const CONVERGED: f64 = 1e-5;
const ROUNDING: f64 = 1.0;
