//! Baseline of all tests: noise, global search for the narrow minimum, recalibration, and size of the
//! discretisation error. Candidate effects are not part of this module.
pub(crate) mod base;
pub mod discretisation_check;
pub(crate) mod establish;
pub mod global_start;
pub(crate) mod input_error;
pub mod narrow_minimum;
pub mod recalibrate;
pub(crate) mod recheck;
pub(crate) mod session;
