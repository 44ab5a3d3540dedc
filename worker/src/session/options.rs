//! Options of a session, and the ways in which it may end.
use crate::{simulator::Simulators, status::StatusFile};
use protocol::id::WorkerId;
use std::{path::PathBuf, sync::Arc, time::Duration};

/// Options of a worker's session with its coordinator.
#[derive(Clone, Debug)]
pub struct SessionOptions {
    /// Kinds of model that the worker simulates.
    pub simulators: Simulators,
    /// Id of the worker.
    pub id: WorkerId,
    /// Number of jobs that the worker computes at a time.
    pub slots: usize,
    /// Program whose `slot` subcommand runs as the slot process; usually the worker's own executable.
    pub program: PathBuf,
    /// Address space of a slot's process (MiB); 0 for no limit.
    pub slot_memory_mib: u64,
    /// Time without work after which the worker ends; `None` for never.
    pub idle_timeout: Option<Duration>,
    /// Whether the worker belongs to one coordinator and ends with its run.
    pub embedded: bool,
    /// File that states whether the worker takes part in a run.
    pub status: Arc<StatusFile>,
}

/// Reason why a worker's session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The worker was asked to end, for example by a signal.
    Asked,
    /// The run to which an embedded worker belongs is over.
    RunOver,
    /// The worker had no work during the idle timeout.
    Idle,
    /// The coordinator refused the worker, with this message as the reason.
    Refused(String),
    /// The link to the coordinator is closed.
    Unlinked,
}
