//! Forward sensitivities of a run: the derivative of each gauge reading with respect to an unknown, exact for
//! the computed (discrete) trajectory.
//!
//! The run itself is identical to a plain run, bit for bit. After every accepted step its stages, taken as
//! solved, are differentiated: `S w = dR/dp + K' dq_b + M dv_b / c`, `S = M / c^2 - D / c - K'`, gives `dq =
//! dq_b + w`, `dv = w / c`, `da = (dv - dv_b) / c` with one factorisation for all columns, which are solved
//! side by side. Step sizes are held fixed, so no decision of the step controller is differentiated; the
//! equilibrium at the start is differentiated as the solution of its equations.
//!
//! Staggered direct method: Feehery, Tolsma and Barton, "Efficient sensitivity analysis of large-scale
//! differential-algebraic systems", Applied Numerical Mathematics 25 (1997).
//!
//! This module does not decide which columns a search needs, nor how an unavailable column is replaced.
mod active;
mod between;
mod block;
mod column;
mod differences;
mod linearized;
mod memory;
mod observer;
mod perturbed;
mod plan;
mod source;

pub use column::{Coefficient, Column, Columns, Derivative, DerivativeCurves, Unavailable};
pub use observer::{simulate, simulate_on};
pub use plan::{ColumnOrigin, DerivativePlan, PlanError};
