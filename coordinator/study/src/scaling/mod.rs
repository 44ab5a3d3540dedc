//! How a search scales with the slots that it is given: measured, and projected to more than there are.
//!
//! Plain data and arithmetic over accounts of slot time. It knows neither who measured nor how it is shown.
mod project;
mod row;

pub use project::{Stand, project};
pub use row::{How, Overheads, Row, Scaled, Shares};
