//! What a pool is given, and what it gives back.
use protocol::{
    id::ContentHash,
    job::{Job, Outcome},
    message::{Attempt, Cost},
};
use std::{path::PathBuf, sync::Arc, time::Duration};

/// The encoded case, as slots are given it.
#[derive(Clone, Debug)]
pub struct CaseBytes {
    /// Its name.
    pub hash: ContentHash,
    /// Its content.
    pub bytes: Arc<[u8]>,
}

/// How the processes of slots are started.
#[derive(Clone, Debug)]
pub struct SlotOptions {
    /// Program whose `slot` subcommand computes.
    pub program: PathBuf,
    /// Address space that a process may have (MiB); 0 for as much as there is.
    pub memory_mib: u64,
}

/// A job for a slot.
#[derive(Clone, Debug)]
pub struct Task {
    /// Which try at which job.
    pub attempt: Attempt,
    /// From start to forced end.
    pub deadline: Duration,
    /// What to do.
    pub job: Box<Job>,
    /// On what.
    pub case: Option<CaseBytes>,
}

/// A slot is free again.
#[derive(Clone, Debug, PartialEq)]
pub struct Freed {
    /// Which slot.
    pub slot: usize,
    /// What it did.
    pub attempt: Attempt,
    /// What that took.
    pub cost: Cost,
    /// What came out; none if it was cancelled.
    pub outcome: Option<Outcome>,
}
