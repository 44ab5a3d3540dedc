//! Work counters: the cost of a simulation in counts that do not depend on the computer.

/// Work of one simulation, including the search for equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of accepted time steps.
    pub steps: u64,
    /// Number of time steps rejected by the error test.
    pub error_rejections: u64,
    /// Number of steps rejected because Newton's method did not converge.
    pub newton_rejections: u64,
    /// Number of Newton iterations; a stage of a Rosenbrock method, one linear solution, counts as one.
    pub newton_iterations: u64,
    /// Number of evaluations of the generalised forces.
    pub force_evaluations: u64,
    /// Number of evaluations of the tangent matrix.
    pub jacobians: u64,
    /// Number of factorisations of the iteration matrix.
    pub factorizations: u64,
}
