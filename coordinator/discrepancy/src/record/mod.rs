//! Measured records, their noise, and the metric that follows from it. The module knows no effect.
pub mod basis;
pub(crate) mod bins;
pub(crate) mod input_scatter;
pub(crate) mod measured;
pub mod metric;
pub mod noise;
pub(crate) mod nuisance;
pub mod samples;
pub(crate) mod scatter;
pub mod spectrum;
pub(crate) mod waves;
pub mod whitened;

pub use input_scatter::InputScatter;
pub use measured::{Curves, Record, Recorded, Split, Stated, mean_of};
pub use nuisance::{Acts, Nuisance};
