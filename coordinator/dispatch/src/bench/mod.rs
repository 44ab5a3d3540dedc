//! Benchmark of the bus with empty jobs, real worker processes and a real journal.
mod load;
mod measure;
mod meter;

pub use load::Load;
pub use measure::{BenchPlan, BenchResult, RoundTrip, measure, measure_on};
pub use meter::processor_time;
