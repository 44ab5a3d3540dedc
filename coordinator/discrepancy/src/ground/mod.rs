//! What every test stands on: the noise, a way into the valley in which resonances fit,
//! the recalibration there, and how far the discretisation matters. It knows no suspect.
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
