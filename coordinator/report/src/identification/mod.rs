//! Report of an identification: which unknowns the record determines, which are correlated, and the resulting
//! uncertainty of predictions.
//!
//! All numbers come from the identification; nothing is recomputed here.
mod chart;
mod csv;
mod section;
mod subject;
mod table;
mod words;
mod write;

pub use subject::IdentificationInput;
pub use write::{report, write};
