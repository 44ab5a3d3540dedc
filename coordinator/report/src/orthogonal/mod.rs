//! Report of an orthogonal-array test of search settings: best levels, significance of the factors, and every
//! run.
//!
//! Takes the test as plain data and does not run it.
mod section;
mod subject;
mod write;

pub(crate) use section::{level_names, runs};
pub use subject::SweepInput;
pub use write::report;
