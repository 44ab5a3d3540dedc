//! What is recorded of a revolution: gauge stress, rope tension, motion, torque.
mod curves;
mod gradient;
mod readings;
mod recorder;
mod shape;
mod stress;
#[cfg(test)]
mod tests;

pub use curves::{Curves, Shape};
pub(crate) use gradient::Gradient;
pub(crate) use readings::{readings, sampled};
pub use recorder::Recorder;
pub use stress::gauge_stress;
