//! What can go wrong with a run, with the remedy where there is one.
use super::locate::LocateError;
use crate::{journal::JournalError, scheduler::Stop};
use link::LinkError;
use protocol::{id::JobId, wire::WireError};
use std::time::Duration;

/// Why a run cannot be opened or go on.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The bus cannot be used.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The worker program is missing.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// The case cannot be encoded.
    #[error("the case cannot be sent to workers: {0}")]
    Case(#[from] WireError),
    /// A local worker cannot be started.
    #[error("local workers cannot be started: {0}")]
    Start(std::io::Error),
    /// Neither local workers nor an address for others.
    #[error(
        "there are no workers to ask: start some with --workers N, or let others join with --listen LOCATOR"
    )]
    NobodyToAsk,
    /// Local workers end again and again, and nobody else can join.
    #[error("the local workers end again and again without a result (the last one {how})")]
    LocalWorkers {
        /// How the last one ended.
        how: String,
    },
    /// The journal holds the result of another job under this name.
    #[error(
        "job {job} of this run was another one when its result was recorded: this build asks other questions than the one that began the run; choose another run folder"
    )]
    JobDiffers {
        /// The job.
        job: JobId,
    },
    /// The journal could not be written for longer than the run was to wait.
    #[error(
        "the journal could not be written for {} s ({why}): the run ends with what it has; make room on the disk, \
         then the same command goes on",
        limit.as_secs()
    )]
    Paused {
        /// What the system says.
        why: String,
        /// How long it waited.
        limit: Duration,
    },
    /// The address to listen on is taken, or is none of this machine.
    #[error("cannot listen on {locator}: {source}")]
    Listen {
        /// The address.
        locator: String,
        /// The system's words.
        source: std::io::Error,
    },
    /// The core gave up.
    #[error("{0}")]
    Stopped(Stop),
    /// The run has been closed or stopped before.
    #[error("the run is closed")]
    Closed,
}

impl From<Stop> for DispatchError {
    fn from(stop: Stop) -> Self {
        Self::Stopped(stop)
    }
}
