//! The state of a run at a moment, for progress lines and reports.
use protocol::{event::Spent, id::WorkerId};

/// A moment of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Workers that take part, by id.
    pub workers: Vec<WorkerSnapshot>,
    /// Jobs that wait for a worker.
    pub queued: usize,
    /// Jobs that a worker holds.
    pub running: usize,
    /// Jobs with an accepted result, of this and earlier processes of the run.
    pub done: usize,
    /// Workers lost by this process.
    pub lost: u32,
    /// Jobs given up by this process.
    pub failed: u32,
    /// Attempts after one that was lost or failed, by this process.
    pub repeated: u32,
    /// Copies of slow jobs that idle workers were given, by this process.
    pub copies: u32,
    /// Results that came after another had been accepted.
    pub duplicates: u64,
    /// Slot time of all workers by use, those that left included.
    pub spent: Spent,
    /// Whether the journal cannot be written, so that nothing is given out.
    pub paused: bool,
}

/// A worker at a moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkerSnapshot {
    /// Its id.
    pub id: WorkerId,
    /// Its machine.
    pub host: String,
    /// Jobs it can compute at a time.
    pub slots: u32,
    /// Jobs it computes.
    pub busy: u32,
    /// Jobs it has brought results of.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// Its slot time by use, since it joined.
    pub spent: Spent,
}
