//! What was measured, cycle by cycle, and the units in which it counts: the noise of the record and
//! the metric that follows from it. It knows no effect.
pub(crate) mod measured;
pub mod metric;
pub mod noise;
pub mod spectrum;
pub(crate) mod tolerance;
pub mod whitened;

pub use measured::{Curves, Record, Recorded, Stated, mean_of};
pub use tolerance::Tolerance;
