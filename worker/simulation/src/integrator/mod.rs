//! Integration of `M(q) a = Q(q, v, t)` in time.
//!
//! A method ([`stepper::Stepper`]) advances a [`State`](crate::system::State) by one step and knows nothing
//! of what is recorded. Step size control and Newton's method with its refactorisation policy are separate
//! objects. A new method takes one file and one line in [`method`].
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
