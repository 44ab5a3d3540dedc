//! Newton's method for one implicit stage, reusing a factorisation of the iteration matrix while it converges
//! fast enough.
use crate::math::vector::{add_scaled, set_sum};
use crate::system::{Equations, Loads, Powers, StateRef, StateShift, System};

/// Policy that decides when the iteration matrix is factorised anew: a small state machine without numerics.
#[derive(Clone, Copy, Debug, Default)]
pub struct RefactorPolicy {
    /// Coefficient gamma of the stage for which the present factorisation was made; `None` without a usable
    /// factorisation.
    made_for: Option<f64>,
    slow: bool,
}

impl RefactorPolicy {
    /// Convergence rate (ratio of successive corrections) above which the next stage starts with a new
    /// factorisation.
    pub const SLOW: f64 = 0.15;
    /// Largest relative change of the coefficient for which a factorisation is reused.
    pub const DRIFT: f64 = 0.25;

    /// Returns whether a stage with coefficient `gamma` needs a new factorisation of the iteration matrix.
    pub fn needs_factorization(&self, gamma: f64) -> bool {
        self.slow
            || self
                .made_for
                .is_none_or(|made| (gamma / made - 1.0).abs() > Self::DRIFT)
    }

    /// Records that the iteration matrix was factorised for the coefficient `gamma`.
    pub const fn record_factorization(&mut self, gamma: f64) {
        self.made_for = Some(gamma);
        self.slow = false;
    }

    /// Records the convergence rate of a stage.
    pub fn record_rate(&mut self, rate: f64) {
        self.slow = rate > Self::SLOW;
    }

    /// Discards the factorisation, after it failed or Newton's method diverged with it.
    pub const fn invalidate(&mut self) {
        self.made_for = None;
    }

    /// Returns the factor by which to scale a Newton correction that was solved with a factorisation for
    /// another coefficient.
    pub fn relaxation(&self, gamma: f64) -> f64 {
        self.made_for
            .map_or(1.0, |made| 2.0 / (1.0 + (gamma / made) * (gamma / made)))
    }
}

/// Implicit stage `q = base_q + c v`, `v = base_v + d a`, `M a = Q`, at time `t`.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitStage<'a> {
    /// Time of the stage \[s\].
    pub t: f64,
    /// Coefficient c \[s\] of the rate in the stage's coordinates.
    pub c: f64,
    /// Coefficient d \[s\] of the acceleration in the stage's rates, equal to c for most methods; the ratio
    /// d/c must be the same for all stages.
    pub d: f64,
    /// Base of the coordinates: their part without the contribution of this stage's rate.
    pub base_q: &'a [f64],
    /// Base of the rates: their part without the contribution of this stage's acceleration.
    pub base_v: &'a [f64],
}

/// Error: Newton's method did not converge, or the iteration matrix is singular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotConverged;

/// Newton's method with its buffers and its refactorisation policy.
#[derive(Clone, Debug)]
pub struct Newton {
    policy: RefactorPolicy,
    accuracy: f64,
    change: Vec<f64>,
}

/// Error that Newton's method may leave in a stage, in units of the error norm, at a step tolerance of 1.
const ACCURACY: f64 = 0.3;
const ITERATIONS: u32 = 10;
/// Largest number of Newton iterations of a stage that is solved to rounding accuracy. `QUADRATIC` is the
/// correction below which quadratic convergence leaves only rounding to correct; `ROUNDING` is the largest
/// correction that rounding may leave.
const MAX_ITERATIONS_TO_ROUNDING: u32 = 40;
const QUADRATIC: f64 = 1e-7;
const ROUNDING: f64 = 1e-4;

impl Newton {
    /// Creates the solver for `n` coordinates and the local error tolerated per step, from which the accuracy
    /// of stages follows: the remaining error of Newton's method must stay below the local error. At a
    /// tolerance of 0, stages are solved to rounding.
    pub fn new(n: usize, tolerance: f64) -> Self {
        Self {
            policy: RefactorPolicy::default(),
            accuracy: ACCURACY * tolerance.min(1.0),
            change: vec![0.0; n],
        }
    }

    /// Solves an implicit stage, starting from the rates predicted in `v`; coordinates and accelerations
    /// follow from the rates.
    ///
    /// Returns the powers at the solution, under the loads of the last evaluation: the last correction is
    /// smaller than Newton's accuracy, and the loads are not evaluated again after it.
    ///
    /// # Errors
    /// [`NotConverged`] if the iteration fails with a fresh factorisation too.
    pub fn solve<E: Equations>(
        &mut self,
        system: &mut System<E>,
        stage: &ImplicitStage<'_>,
        (q, v, a): (&mut [f64], &mut [f64], &mut [f64]),
    ) -> Result<Powers, NotConverged> {
        if self.accuracy == 0.0 {
            return self.solve_to_rounding(system, stage, (q, v, a));
        }
        let StateShift { mass, damping } = stage.shift();
        let mut fresh = false;
        predict(stage, q, v, a);
        let mut loads = system.residual(StateRef { t: stage.t, q, v }, a, &mut self.change);
        if self.policy.needs_factorization(damping) {
            self.factorize(&mut loads, stage)?;
            fresh = true;
        }
        let mut last: Option<f64> = None;
        let mut rate: f64 = 0.0;
        for iteration in 0..ITERATIONS {
            loads.statistics().newton_iterations += 1;
            loads.solve(&mut self.change);
            let relax = self.policy.relaxation(damping);
            for change in &mut self.change {
                *change *= relax;
            }
            let norm = loads.equations().newton_norm(&self.change);
            if let Some(last) = last {
                rate = (0.3 * rate).max(norm / last);
            }
            let converged = if iteration == 0 {
                norm < 0.1 * self.accuracy
            } else {
                rate < 1.0 && norm * rate / (1.0 - rate) < self.accuracy
            };
            let kept = loads.release_state();
            add_scaled(q, 1.0, &self.change);
            add_scaled(v, damping, &self.change);
            add_scaled(a, mass, &self.change);
            if converged {
                self.policy.record_rate(rate);
                return Ok(kept.powers(StateRef { t: stage.t, q, v }, a));
            }
            let hopeless = !norm.is_finite()
                || rate > 2.0
                || (rate > 0.9 && iteration > 2)
                || iteration + 1 == ITERATIONS;
            if hopeless {
                if fresh {
                    break;
                }
                fresh = true;
                last = None;
                rate = 0.0;
                v.copy_from_slice(stage.base_v);
                predict(stage, q, v, a);
                loads = system.residual(StateRef { t: stage.t, q, v }, a, &mut self.change);
                self.factorize(&mut loads, stage)?;
                continue;
            }
            last = Some(norm);
            loads = system.residual(StateRef { t: stage.t, q, v }, a, &mut self.change);
        }
        self.policy.invalidate();
        Err(NotConverged)
    }

    /// Solves a stage to rounding accuracy, with a new factorisation in every iteration.
    fn solve_to_rounding<E: Equations>(
        &mut self,
        system: &mut System<E>,
        stage: &ImplicitStage<'_>,
        (q, v, a): (&mut [f64], &mut [f64], &mut [f64]),
    ) -> Result<Powers, NotConverged> {
        let StateShift { mass, damping } = stage.shift();
        predict(stage, q, v, a);
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS_TO_ROUNDING {
            let mut loads = system.residual(StateRef { t: stage.t, q, v }, a, &mut self.change);
            loads.statistics().newton_iterations += 1;
            self.factorize(&mut loads, stage)?;
            loads.solve(&mut self.change);
            let norm = loads.equations().newton_norm(&self.change);
            let kept = loads.release_state();
            add_scaled(q, 1.0, &self.change);
            add_scaled(v, damping, &self.change);
            add_scaled(a, mass, &self.change);
            // below, the next change would be rounding; or it is already, and shrinks no more
            if norm < QUADRATIC || (norm < ROUNDING && norm > 0.5 * last) {
                return Ok(kept.powers(StateRef { t: stage.t, q, v }, a));
            }
            last = norm;
        }
        Err(NotConverged)
    }

    fn factorize<E: Equations>(
        &mut self,
        loads: &mut Loads<'_, '_, E>,
        stage: &ImplicitStage<'_>,
    ) -> Result<(), NotConverged> {
        let shift = stage.shift();
        if loads.factorize(shift).is_err() {
            self.policy.invalidate();
            return Err(NotConverged);
        }
        self.policy.record_factorization(shift.damping);
        Ok(())
    }
}

impl ImplicitStage<'_> {
    /// Returns the coefficients of the stage's iteration matrix: rates change `damping` times and
    /// accelerations `mass` times as much as coordinates.
    fn shift(&self) -> StateShift {
        let damping = 1.0 / self.c;
        StateShift {
            mass: damping * (1.0 / self.d),
            damping,
        }
    }
}

/// Computes the coordinates and accelerations that correspond to the predicted rates in a stage.
fn predict(stage: &ImplicitStage<'_>, q: &mut [f64], v: &[f64], a: &mut [f64]) {
    set_sum(q, stage.base_q, stage.c, v);
    set_sum(a, v, -1.0, stage.base_v);
    for a in a {
        *a /= stage.d;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a new factorisation is requested for the first stage, after a change of the coefficient by
    /// more than a quarter, after slow convergence and after a failure, and in no other case.
    #[test]
    fn a_factorisation_is_kept_while_it_serves() {
        let mut policy = RefactorPolicy::default();
        assert!(policy.needs_factorization(100.0));
        policy.record_factorization(100.0);
        for gamma in [75.1, 100.0, 124.9] {
            assert!(!policy.needs_factorization(gamma), "{gamma}");
        }
        for gamma in [74.9, 125.1] {
            assert!(policy.needs_factorization(gamma), "{gamma}");
        }
        policy.record_rate(RefactorPolicy::SLOW);
        assert!(!policy.needs_factorization(100.0));
        policy.record_rate(1.01 * RefactorPolicy::SLOW);
        assert!(policy.needs_factorization(100.0));
        policy.record_factorization(100.0);
        assert!(!policy.needs_factorization(100.0));
        policy.invalidate();
        assert!(policy.needs_factorization(100.0));
    }

    /// Checks the factor that scales a Newton correction for another coefficient: if inertia (gamma squared)
    /// and stiffness have equal weight at the coefficient `made`, the relative errors of a correction are
    /// equal for both and of opposite sign.
    #[test]
    fn a_correction_is_scaled_for_another_coefficient() {
        let mut policy = RefactorPolicy::default();
        assert_eq!(policy.relaxation(3.0).to_bits(), 1.0_f64.to_bits());
        policy.record_factorization(100.0);
        for gamma in [80.0_f64, 100.0, 120.0] {
            let relax = policy.relaxation(gamma);
            let inertia = 1.0 - relax * (gamma / 100.0).powi(2);
            let stiffness = 1.0 - relax;
            assert!((inertia + stiffness).abs() < 1e-12, "{gamma}: {relax}");
        }
    }
}
