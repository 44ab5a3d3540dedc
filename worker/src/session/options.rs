//! How a session is set up, and how it may end.
use crate::simulator::Simulators;
use protocol::id::WorkerId;
use std::{path::PathBuf, time::Duration};

/// How a session is set up.
#[derive(Clone, Debug)]
pub struct SessionOptions {
    /// The models that it simulates.
    pub simulators: Simulators,
    /// The worker's name.
    pub id: WorkerId,
    /// Jobs computed at a time.
    pub slots: usize,
    /// Program whose `slot` subcommand computes; usually this one.
    pub program: PathBuf,
    /// Address space that a slot's process may have (MiB); 0 for as much as there is.
    pub slot_memory_mib: u64,
    /// Without work for so long the worker ends; never by default.
    pub idle_timeout: Option<Duration>,
    /// Whether it belongs to one coordinator and ends with its run.
    pub embedded: bool,
}

/// Why a session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It was asked to.
    Asked,
    /// The run is over and the worker belongs to it.
    RunOver,
    /// There was no work for the given time.
    Idle,
    /// The coordinator does not take it.
    Refused(String),
    /// The link is closed.
    Unlinked,
}
