//! Interface of all integration methods: a step of a given size, and its acceptance or rejection.
use super::{newton::NotConverged, step_control::StepControl, tableau::Tableau};
use crate::system::{Equations, Powers, State, System};
use std::fmt::Debug;

/// Result of one integration step: its local error and the work done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStep {
    /// Local error in units of the error norm.
    pub error: f64,
    /// Work done during the step \[J\]: input, output, dissipated.
    pub work: Powers,
}

/// Stages of the last step of a Runge-Kutta method with an explicit first stage; needed for differentiating
/// the discrete trajectory.
#[derive(Clone, Copy, Debug)]
pub struct Stages<'a> {
    /// Coefficients of the method.
    pub tableau: &'static Tableau,
    /// Rates and accelerations of all stages except the last, which is the end of the step.
    pub rates: &'a [(Vec<f64>, Vec<f64>)],
}

/// Result of an integration step, or the failure of Newton's method in it.
pub type StepResult = Result<TimeStep, NotConverged>;

/// Integration method with its buffers and its history of earlier steps.
///
/// It knows neither what is recorded nor which size a step should have, except where it overrides
/// [`Stepper::next`].
pub trait Stepper<E: Equations>: Debug {
    /// Makes one step of size `h` from the state `from`, the end of the last accepted step; its end is
    /// written into `to`.
    ///
    /// Afterwards the equations keep the loads of the method's last evaluation, which equal the loads at `to`
    /// up to Newton's accuracy. [`System::forces`] evaluates the loads at `to` itself.
    ///
    /// # Errors
    /// [`NotConverged`] if the step could not be made; `to` is then meaningless.
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> StepResult;

    /// Accepts the last step, which ends in `to`, into the method's history.
    fn accept(&mut self, equations: &E, to: &State);

    /// Rejects the last step, which failed or exceeded the tolerance; another step from the same state
    /// follows.
    fn reject(&mut self) {}

    /// Returns the stages of the last step, or `None` if the method has no Runge-Kutta stages.
    fn stages(&self) -> Option<Stages<'_>> {
        None
    }

    /// Returns the order of the last step's error estimate with respect to the step size.
    fn error_order(&self) -> f64;

    /// Returns the size of the step \[s\] that follows an accepted step of size `step` and local error
    /// `error`.
    fn next(&mut self, control: &StepControl, step: f64, error: f64) -> f64 {
        control.next(step, error)
    }
}
