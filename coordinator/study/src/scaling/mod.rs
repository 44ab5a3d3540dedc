//! Scaling of a search with the number of slots: measured, and projected to more slots than are available.
//!
//! Data types and arithmetic over accounts of slot time, independent of the measurement and of the display.
mod project;
mod row;

pub use project::{SyntheticObjective, project};
pub use row::{Overheads, ScalingResult, ScalingRow, Shares, SlotMode};
