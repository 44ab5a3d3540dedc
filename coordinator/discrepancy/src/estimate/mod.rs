//! Estimation of sizes: sizes of the answer with their intervals, detection limits, and the data that would
//! separate effects.
pub mod absorbed;
pub mod discrepancy;
pub mod effect_size;
pub mod experiment_design;
pub mod force;
pub mod limit;
pub mod neighbourhood;
pub mod nuisances;
pub mod spread;
