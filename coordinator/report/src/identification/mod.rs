//! What people see of an identification: which unknowns the record sees, which trade off, and what that
//! leaves open in predictions.
//!
//! Everything is the identification's own number: nothing is computed again here.
mod chart;
mod csv;
mod section;
mod subject;
mod table;
mod words;
mod write;

pub use subject::Subject;
pub use write::{report, write};
