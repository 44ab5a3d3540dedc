//! The asynchronous glue between link, core and journal, and the only way to have work done.
//!
//! [`Dispatch`] is opened on a run folder, given jobs and asked for results. What it does in
//! between runs on a task of its own, so that a caller that computes for a while holds up nobody.
mod bench;
pub mod control;
mod crew;
mod dispatch;
mod engine;
mod error;
mod listen;
mod local;
pub mod locate;
mod options;
mod parts;
mod sleep;

pub use crate::scheduler::{Completed, Policy, Snapshot, WorkerSnapshot};
pub use bench::{
    BenchPlan, BenchResult, BenchWorkers, Silence, SilentPlan, SilentResult, Slept, bench, connect,
    keep_silent, processor_time, sleep_through,
};
pub use dispatch::Dispatch;
pub use engine::Summary;
pub use error::DispatchError;
pub use options::{DispatchOptions, PAUSE_LIMIT};
pub use protocol::event::{RunHeader, Spent};
