//! Asynchronous glue between link, core and journal, and the only interface for running jobs.
//!
//! [`Dispatch`] is opened on a run folder, given jobs and asked for results. It runs on a task of its own, so
//! that a caller busy with computations delays no worker.
pub mod control;
mod coordination;
mod dispatch;
mod divide;
mod engine;
mod error;
mod listen;
mod local;
pub mod locate;
mod options;
mod parts;
mod suspend;
mod worker_control;

pub use crate::scheduler::{Completed, PAUSE_LIMIT, Policy, Snapshot};
#[cfg(any(test, feature = "simulated"))]
pub(crate) use coordination::Coordination;
pub use dispatch::Dispatch;
#[cfg(test)]
pub(crate) use divide::by_columns::ByColumns;
pub use divide::{Divide, Undivided};
#[cfg(any(test, feature = "simulated"))]
pub(crate) use divide::{anticipated_parts, part_count};
pub use engine::RunSummary;
pub use error::DispatchError;
pub use journal::event::{RunHeader, Spent};
pub use listen::{allow_connections, local_socket};
pub use options::{DispatchOptions, RemoteAccess};
