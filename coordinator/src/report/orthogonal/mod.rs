//! The report of an orthogonal test: what is best, whether chance could have said the same, every run.
//!
//! Knows the test as plain data, not who ran it.
mod section;
mod subject;
mod write;

pub(crate) use section::runs;
pub(crate) use subject::Subject;
pub(crate) use write::{report, write};
