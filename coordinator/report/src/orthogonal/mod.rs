//! The report of an orthogonal test: what is best, whether chance could have said the same, every run.
//!
//! Knows the test as plain data, not who ran it.
mod section;
mod subject;
mod write;

pub use section::runs;
pub use subject::Subject;
pub use write::{report, write};
