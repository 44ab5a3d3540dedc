//! Levenberg-Marquardt on a residual vector: the search that uses every sample of a curve.
//!
//! Minimises `|r(x)|^2 + sum ((x_k - mean_k) / deviation_k)^2` inside a box. The search plans batches of
//! points and absorbs their residual vectors: first the columns of the Jacobian, known or differenced, then a
//! fan of damped steps of which the best is taken. It does not know the meaning of a point or where it is
//! evaluated; a point that could not be evaluated is a missing value, never a large number.
//!
//! Sources: Moré, "The Levenberg-Marquardt algorithm: implementation and theory" (1978); the fan of
//! speculative dampings is that of parallel calibrators such as PEST++.
mod differences;
pub(crate) mod problem;
pub(crate) mod search;
mod step;
#[cfg(test)]
mod tests;

pub use problem::{EvaluatedPoint, LeastSquaresSettings, Linearized, Prior, Termination, Variable};
pub use search::{Anticipated, LeastSquares};
pub use step::{linear_minimum, prior_cost, undamped};
