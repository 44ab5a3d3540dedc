//! Work counters: what a simulation cost, in numbers that do not depend on the machine it ran on.

/// Work of one simulation, settle included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Steps rejected by the error test.
    pub error_rejections: u64,
    /// Steps rejected because Newton's method did not converge.
    pub newton_rejections: u64,
    /// Newton iterations; a stage of a Rosenbrock method, one linear solution, counts as one.
    pub newton_iterations: u64,
    /// Evaluations of the generalised forces.
    pub force_evaluations: u64,
    /// Evaluations of the tangent.
    pub jacobians: u64,
    /// Factorisations.
    pub factorizations: u64,
}
