//! General utilities shared by several crates of the coordinator.
pub mod atomic_file;
pub mod interpolation;
pub mod problem;
pub mod quantile;

pub use problem::Problem;
