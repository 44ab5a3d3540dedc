//! How large: sizes of the answer with their intervals, the sizes from which on effects would have
//! been seen, and what more data would tell apart.
pub mod absorbed;
pub mod data_value;
pub mod estimate;
pub mod force;
pub mod limit;
pub mod never_exact;
pub mod spread;
