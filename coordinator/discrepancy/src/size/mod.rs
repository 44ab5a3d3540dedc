//! Estimation of sizes: sizes of the answer with their intervals, detection limits, and the data that would
//! separate effects.
pub mod absorbed;
pub mod data_value;
pub mod estimate;
pub mod force;
pub mod limit;
pub mod never_exact;
pub mod spread;
