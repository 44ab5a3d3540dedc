//! Tasks that the pool of slots receives, and results that it returns.
use protocol::{
    id::ContentHash,
    job::{Job, Outcome},
    message::{Attempt, Cost},
};
use std::{path::PathBuf, sync::Arc, time::Duration};

/// Encoded case with its content hash, as sent to slot processes.
#[derive(Clone, Debug)]
pub struct CaseBytes {
    /// Content hash of the case.
    pub hash: ContentHash,
    /// Bytes of the encoded case.
    pub bytes: Arc<[u8]>,
}

/// Options for starting the slot processes.
#[derive(Clone, Debug)]
pub struct SlotOptions {
    /// Program whose `slot` subcommand runs as the slot process.
    pub program: PathBuf,
    /// Address space of a slot process (MiB); 0 for no limit.
    pub memory_mib: u64,
}

/// Job to be run in a slot.
#[derive(Clone, Debug)]
pub struct Task {
    /// Attempt to which the job belongs.
    pub attempt: Attempt,
    /// Time limit of the job, after which its process is ended.
    pub deadline: Duration,
    /// Job to be evaluated.
    pub job: Box<Job>,
    /// Case of the job; `None` for a job without a case.
    pub case: Option<CaseBytes>,
}

/// Notification that a slot has finished its job and is free again.
#[derive(Clone, Debug, PartialEq)]
pub struct Freed {
    /// Index of the slot that is free again.
    pub slot: usize,
    /// Attempt that the slot worked on.
    pub attempt: Attempt,
    /// Cost of the attempt, as reported to the coordinator.
    pub cost: Cost,
    /// Outcome of the job; `None` if it was cancelled.
    pub outcome: Option<Outcome>,
}
