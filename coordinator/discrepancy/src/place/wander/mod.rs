//! Parameters that would have to vary along the abscissa or with the condition.
pub(crate) mod refit;
pub(crate) mod sheet;
pub(crate) mod shifts;

pub use shifts::{Part, Shift, Wander};
