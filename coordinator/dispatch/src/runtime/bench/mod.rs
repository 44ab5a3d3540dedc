//! Benchmark of the bus with empty jobs and a real journal; workers are real processes, or mere sessions
//! where there are more workers than this machine can run as processes.
mod load;
mod measure;
mod meter;
mod plan;
mod sessions;
mod silent;
mod slept;

pub use measure::bench;
pub use meter::processor_time;
pub use plan::{BenchPlan, BenchResult, BenchWorkers, Silence, SilentPlan, SilentResult};
pub use sessions::connect;
pub use silent::keep_silent;
pub use slept::{Slept, sleep_through};
