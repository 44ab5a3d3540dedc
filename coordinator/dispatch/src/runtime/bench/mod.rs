//! Benchmark of the bus with empty jobs and a real journal; workers are real processes, or mere sessions
//! where there are more workers than this machine can run as processes.
mod load;
mod measure;
mod meter;
mod plan;
mod sessions;
mod silent;
mod sleeping_jobs;

pub use measure::bench;
pub use meter::processor_time;
pub use plan::{BenchPlan, BenchResult, BenchWorkers, SilentPlan, SilentResult, SilentStage};
pub use sessions::connect;
pub use silent::keep_silent;
pub use sleeping_jobs::{SleepingJobsResult, sleep_through};
