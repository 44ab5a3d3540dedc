//! What all methods of integration have in common: a step of a given size, and what it may be told.
use super::{newton::NotConverged, step_control::StepControl, tableau::Tableau};
use crate::system::{Equations, Powers, State, System};
use std::fmt::Debug;

/// Result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Local error in units of the error norm.
    pub error: f64,
    /// Work done during the step: input, output, dissipated \[J\].
    pub work: Powers,
}

/// The stages of a step with an explicit first stage: what the discrete trajectory is differentiated
/// through.
#[derive(Clone, Copy, Debug)]
pub struct Stages<'a> {
    /// The method.
    pub tableau: &'static Tableau,
    /// Rates and accelerations of the stages but the last, which is where the step ended.
    pub rates: &'a [(Vec<f64>, Vec<f64>)],
}

/// A step that was made, or could not be.
pub type Tried = Result<Step, NotConverged>;

/// A method of integration with its buffers and whatever it remembers of earlier steps.
///
/// It knows neither what is recorded nor which size a step should have, unless it says so in
/// [`Stepper::next`].
pub trait Stepper<E: Equations>: Debug {
    /// One step of size `h` from `from`, where the last accepted step ended, into `to`.
    ///
    /// The loads that the equations keep afterwards are those of the method's last evaluation: of `to`,
    /// up to Newton's accuracy. Who needs those of `to` itself asks [`System::forces`].
    ///
    /// # Errors
    /// [`NotConverged`] when the step could not be made; `to` is then meaningless.
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> Tried;

    /// The last step was accepted; it ends in `to`.
    fn accept(&mut self, equations: &E, to: &State);

    /// The last step failed or erred too much: another one from the same state will follow.
    fn reject(&mut self) {}

    /// The stages of the last step, of a method that has such.
    fn stages(&self) -> Option<Stages<'_>> {
        None
    }

    /// Order of the last step's error estimate in its size.
    fn error_order(&self) -> f64;

    /// Size of the step after the accepted one \[s\].
    fn next(&mut self, control: &StepControl, step: f64, error: f64) -> f64 {
        control.next(step, error)
    }
}
