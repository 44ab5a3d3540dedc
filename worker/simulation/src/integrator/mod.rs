//! Integration of `M(q) a = Q(q, v, t)` in time.
//!
//! A method ([`stepper::Stepper`]) advances a [`State`](crate::system::State) by one step and knows nothing
//! of what is recorded. Step size control and Newton's method with its refactorisation policy are separate
//! objects. A new method takes one file and its arms in [`method`]. The feature `comparison` adds methods that judge those
//! in use.
pub mod adaptive;
#[cfg(feature = "comparison")]
pub mod bdf;
pub mod dense;
pub mod esdirk;
#[cfg(feature = "comparison")]
pub mod generalized_alpha;
pub mod method;
pub mod newton;
#[cfg(feature = "comparison")]
pub mod rosenbrock;
pub mod step_control;
pub mod stepper;
pub mod tableau;
