//! Measured records, their noise, and the metric that follows from it.
//!
//! All functions are pure functions of records and curves, without input, output or clock. The crate knows neither
//! simulations nor effects.
pub mod basis;
pub mod bins;
mod input_scatter;
mod measured;
pub mod metric;
pub mod noise;
mod nuisance;
pub mod samples;
mod scatter;
pub mod spectrum;

pub use input_scatter::InputScatter;
#[cfg(any(test, feature = "fixtures"))]
pub use measured::recorded;
pub use measured::{
    Curves, Record, Recorded, Split, Stated, difference, mean_of, power, scatter, variance,
};
pub use nuisance::{Acts, Nuisance};
