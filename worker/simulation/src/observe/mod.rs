//! Recording of a revolution: gauge stress, rope tension, motion, torque.
mod curves;
mod gradient;
mod readings;
mod recorder;
mod shaft;
mod shape;
mod stress;
#[cfg(test)]
mod tests;

pub use curves::{Curves, HeadLoadCurves, Shape};
pub(crate) use gradient::Gradient;
pub(crate) use readings::{readings, recovered_stress, sampled};
pub use recorder::Recorder;
pub(crate) use shaft::{TorqueBy, shaft, turned_by_ropes};
pub use stress::gauge_stress;
