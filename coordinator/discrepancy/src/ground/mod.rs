//! Baseline of all tests: noise, global search for the narrow minimum, recalibration, and size of the
//! discretisation error. Candidate effects are not part of this module.
pub(crate) mod base;
pub mod basin;
pub(crate) mod believed;
pub mod budget;
pub(crate) mod establish;
pub(crate) mod input_error;
pub mod preflight;
pub mod recalibrate;
pub(crate) mod session;
pub mod valley;
