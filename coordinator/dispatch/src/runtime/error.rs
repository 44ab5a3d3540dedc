//! Errors of opening and running a run, with the remedy where there is one.
use super::locate::LocateError;
use crate::scheduler::StopReason;
use journal::JournalError;
use link::LinkError;
use protocol::{id::JobId, wire::WireError};
use std::time::Duration;

/// Reason why a run cannot be opened or cannot continue.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// Error of the run's journal.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Error of the message bus between coordinator and workers.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The socket for local workers cannot be made.
    #[error("the socket for workers on this machine cannot be made: {0}")]
    Socket(std::io::Error),
    /// The worker program is missing.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// The case cannot be encoded.
    #[error("the case cannot be sent to workers: {0}")]
    Case(#[from] WireError),
    /// A local worker cannot be started.
    #[error("local workers cannot be started: {0}")]
    Start(std::io::Error),
    /// The run has neither local workers nor an address for remote ones.
    #[error(
        "the run has no workers: start local ones with --workers N, or let others join with --listen LOCATOR"
    )]
    NoWorkers,
    /// Local workers end repeatedly without a result, and no other workers can join.
    #[error("the local workers keep ending without a result (the last one {how})")]
    LocalWorkers {
        /// Description of how the last local worker exited.
        how: String,
    },
    /// The journal holds the result of a different job under this number.
    #[error(
        "the journal of this run holds the result of a different job {job}: this build submits other jobs than the build that began the run; continue with that build, or choose another run folder"
    )]
    JobDiffers {
        /// Number of the job whose results differ.
        job: JobId,
    },
    /// The journal could not be written for longer than the pause limit.
    #[error(
        "the journal could not be written for {} s ({why}): the run ends with the results it has; free space on the disk, \
         then repeat the command to continue",
        limit.as_secs()
    )]
    Paused {
        /// Error of the operating system that prevents writing the journal.
        why: String,
        /// Maximum duration of a pause while the journal cannot be written.
        limit: Duration,
    },
    /// The address to listen on is in use, or is not an address of this machine.
    #[error("cannot listen on {locator}: {source}")]
    Listen {
        /// Address in the notation of the bus (locator), e.g. `tcp/0.0.0.0:7447`.
        locator: String,
        /// Error of the operating system when listening on the address.
        source: std::io::Error,
    },
    /// The scheduler core stopped the run.
    #[error("{0}")]
    Stopped(StopReason),
    /// The run was closed or stopped before.
    #[error("the run is closed")]
    Closed,
}

impl From<StopReason> for DispatchError {
    fn from(stop: StopReason) -> Self {
        Self::Stopped(stop)
    }
}
