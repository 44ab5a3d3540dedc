//! Forward sensitivities of a run: what each gauge reads more of when an unknown grows, exactly for the
//! trajectory as it was computed.
//!
//! The run itself is the plain one, bit for bit. Behind every accepted step its stages, taken as solved,
//! are differentiated: `S w = dR/dp + K' dq_b + M dv_b / c`, `S = M / c^2 - D / c - K'`, gives
//! `dq = dq_b + w`, `dv = w / c`, `da = (dv - dv_b) / c` with one factorisation for all columns, which are
//! solved side by side. Step sizes are what they were, so nothing is differentiated that a
//! controller decided; the equilibrium at the start is differentiated as the solution of its equations.
//!
//! Staggered direct method: Feehery, Tolsma and Barton, "Efficient sensitivity analysis of large-scale
//! differential-algebraic systems", Applied Numerical Mathematics 25 (1997).
//!
//! Unknown here: which columns a search wants, and what a fall-back for a missing one is.
mod active;
mod between;
mod block;
mod column;
mod differences;
mod follow;
mod linearized;
mod plan;
mod side;
mod source;

pub use column::{Changes, Coefficient, Column, Columns, Derivative, Missing};
pub use follow::{simulate, simulate_on};
pub use plan::{Origin, Plan, Refused};
