//! Small tools that several crates of the coordinator share and that know nothing of it.
pub mod atomic_file;
pub mod interpolation;
pub mod problem;
pub mod quantile;

pub use problem::Problem;
