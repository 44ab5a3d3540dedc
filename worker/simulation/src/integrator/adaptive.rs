//! Adaptive step size control: tries integration steps of a size that follows the local error, and counts
//! failed ones.
use super::method::Method;
use super::step_control::StepControl;
use super::stepper::{Stages, Stepper, TimeStep};
use crate::system::{Equations, State, System};

/// Integration method with adaptive step size.
#[derive(Debug)]
pub struct Adaptive<E> {
    method: Box<dyn Stepper<E>>,
    control: StepControl,
    /// Size of the next step \[s\].
    step: f64,
    /// Upper limit of the step size that remains after a failure of Newton's method \[s\].
    step_limit: f64,
    /// Number of steps accepted since the last failure of Newton's method, up to [`FAILURE_MEMORY_STEPS`].
    steps_since_failure: u32,
}

/// Error: the step size control would need a step shorter than the shortest allowed one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepUnderflow;

/// Number of accepted steps after which a failure of Newton's method counts as unrelated to the previous one.
/// After two failures closer together, the step size is limited to `FAILURE_STEP_FACTOR` times that of the
/// failed step, and this limit grows by `RECOVERY_FACTOR` with every accepted step: the error estimate alone
/// does not see a chattering contact and would lead straight back into the failure.
const FAILURE_MEMORY_STEPS: u32 = 4;
const FAILURE_STEP_FACTOR: f64 = 0.6;
const RECOVERY_FACTOR: f64 = 1.1;
/// Number of failures of Newton's method after which the longest step is multiplied by `SHORTENING` for the rest of
/// the run.
///
/// In a long step the stages of a strongly damped contact have several solutions. The method fails at some, and
/// others that it finds leave the cylinders in motions that take thousands of short steps; the error estimate sees
/// neither. 40 machines with such contacts and cylinders of 150 mm take 0.49 times the iterations with this rule, and
/// the energy of 12 of them is off by more than 0.1 %, without it of 21. After 32 failures instead of 100 it would
/// be 0.45 times and 10, but accurate runs of other methods fail 38 and 78 times in a revolution, and would lose their
/// long steps.
const FAILURES: u64 = 100;
const SHORTENING: f64 = 0.25;
/// Shortest step \[s\]; a run that needs shorter ones ends with an error.
const SHORTEST_STEP: f64 = 1e-9;

impl<E: Equations> Adaptive<E> {
    /// Creates an integrator for a system, with the local error `tolerance` allowed per step and steps of at
    /// most `longest` \[s\].
    pub fn new(method: Method, system: &System<E>, tolerance: f64, longest: f64) -> Self {
        let method = method.stepper(system, tolerance);
        Self {
            control: StepControl {
                order: method.error_order(),
                tolerance,
                longest,
                shortest: SHORTEST_STEP,
            },
            method,
            step: 1e-3_f64.min(longest),
            step_limit: longest,
            steps_since_failure: FAILURE_MEMORY_STEPS,
        }
    }

    /// Makes one step from the state `from` to the given time `end` without error control. Finite differences
    /// of whole runs use it, so that they do not include changed decisions of the step size control.
    ///
    /// # Errors
    /// [`StepUnderflow`] if the step fails.
    pub fn step_without_error_control(
        &mut self,
        system: &mut System<E>,
        from: &State,
        end: f64,
        to: &mut State,
    ) -> Result<TimeStep, StepUnderflow> {
        let made = self.method.step(system, from, end - from.t, to);
        let step = made.map_err(|_| StepUnderflow)?;
        to.t = end;
        system.statistics.steps += 1;
        self.method.accept(&system.equations, to);
        Ok(step)
    }

    /// Returns the intermediate stages of the last step, or `None` if the method has no Runge-Kutta stages.
    pub fn stages(&self) -> Option<Stages<'_>> {
        self.method.stages()
    }

    /// Tries one step from `from` towards `stop`, which is met exactly; returns `None` if the step is
    /// rejected, in which case `to` is meaningless.
    ///
    /// # Errors
    /// [`StepUnderflow`] if failures have made the step too short.
    pub fn attempt(
        &mut self,
        system: &mut System<E>,
        from: &State,
        stop: f64,
        to: &mut State,
    ) -> Result<Option<TimeStep>, StepUnderflow> {
        if self.step < self.control.shortest {
            return Err(StepUnderflow);
        }
        let left = stop - from.t;
        let step = if self.step >= left {
            left
        } else if self.step > 0.5 * left {
            0.5 * left
        } else {
            self.step
        };
        let tolerance = self.control.tolerance;
        match self.method.step(system, from, step, to) {
            Err(_) => {
                system.statistics.newton_rejections += 1;
                self.method.reject();
                self.step = 0.3 * step;
                if self.steps_since_failure < FAILURE_MEMORY_STEPS {
                    self.step_limit = FAILURE_STEP_FACTOR * step;
                }
                self.steps_since_failure = 0;
                if system.statistics.newton_rejections == FAILURES {
                    self.control.longest *= SHORTENING;
                }
                Ok(None)
            }
            Ok(done) if done.error > tolerance || !done.error.is_finite() => {
                system.statistics.error_rejections += 1;
                self.control.order = self.method.error_order();
                self.method.reject();
                self.step = step * self.control.factor(done.error).min(0.7);
                Ok(None)
            }
            Ok(done) => {
                system.statistics.steps += 1;
                self.control.order = self.method.error_order();
                self.method.accept(&system.equations, to);
                let next = self.method.next(&self.control, step, done.error);
                let next = next.min(self.step_limit);
                self.step_limit = (self.step_limit * RECOVERY_FACTOR).min(self.control.longest);
                self.steps_since_failure = (self.steps_since_failure + 1).min(FAILURE_MEMORY_STEPS);
                // a step that was cut short to meet `stop` says nothing of the one after it
                if step >= self.step {
                    self.step = next;
                }
                Ok(Some(done))
            }
        }
    }
}
