//! Parameters that would have to vary along the abscissa or with the condition.
pub(crate) mod linear_record;
pub(crate) mod refit;
pub(crate) mod shifts;

pub use shifts::{ParameterDrift, ParameterShift, RecordPart};
