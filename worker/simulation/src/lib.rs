//! Rigid-flexible multibody dynamics.
pub mod math;
