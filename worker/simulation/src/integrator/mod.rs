//! Integration of `M(q) a = Q(q, v, t)` in time.
//!
//! A method ([`stepper::Stepper`]) advances a [`State`] by one step and knows nothing of what is
//! recorded. Step size control and Newton's method with its refactorisation policy are small objects
//! of their own. A new method costs one file and one line in [`method`].
pub mod adaptive;
pub mod bdf;
pub mod dense;
pub mod esdirk;
pub mod generalized_alpha;
pub mod method;
pub mod newton;
pub mod rosenbrock;
pub mod step_control;
pub mod stepper;
pub mod tableau;

/// Coordinates, rates and accelerations at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rates.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

impl State {
    /// At rest.
    pub fn at_rest(t: f64, q: Vec<f64>) -> Self {
        let n = q.len();
        Self {
            t,
            q,
            v: vec![0.0; n],
            a: vec![0.0; n],
        }
    }
}
