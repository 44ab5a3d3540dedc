//! What the core remembers of jobs and workers.
use super::policy::Failures;
use protocol::{
    announce::Announcement,
    id::{ContentHash, JobId, WorkerId},
    job::Job,
    message::Attempt,
};
use std::{collections::BTreeSet, time::Duration};

/// A job without an accepted result.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) job: Job,
    pub(super) work: ContentHash,
    /// Next attempt of this coordinator process.
    pub(super) next: u32,
    /// Workers that hold it now.
    pub(super) holders: Vec<WorkerId>,
    pub(super) refused_by: BTreeSet<WorkerId>,
    pub(super) failures: Failures,
}

/// A job in the hands of a worker.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lease {
    pub(super) attempt: Attempt,
    /// When it was last sent.
    pub(super) sent: Duration,
    /// When the worker first said that it computes it.
    pub(super) running: Option<Duration>,
    pub(super) deadline: Duration,
}

/// An admitted worker.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) announcement: Announcement,
    pub(super) since: Duration,
    pub(super) heard: Duration,
    /// It has the case and may be given jobs.
    pub(super) ready: bool,
    /// In the order in which they were sent; about the first `slots` of them compute.
    pub(super) leases: Vec<Lease>,
    /// It holds a job in quarantine and gets nothing else.
    pub(super) alone: bool,
    /// Attempts it holds of jobs that were not submitted (yet).
    pub(super) claims: Vec<Attempt>,
    pub(super) done: u64,
    pub(super) failed: u64,
    pub(super) spent: Spent,
}

impl Member {
    pub(super) fn slots(&self) -> usize {
        self.announcement.slots as usize
    }

    pub(super) fn holds(&self, job: JobId) -> bool {
        self.leases.iter().any(|lease| lease.attempt.job == job)
    }

    pub(super) fn drop_lease(&mut self, job: JobId) -> Option<Lease> {
        let at = self
            .leases
            .iter()
            .position(|lease| lease.attempt.job == job)?;
        let lease = self.leases.remove(at);
        self.alone &= !self.leases.is_empty();
        Some(lease)
    }
}

/// Slot time by use \[us\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spent {
    /// Slots times the time they were connected.
    pub connected_us: u64,
    /// On accepted results.
    pub useful_us: u64,
    /// On attempts that failed.
    pub failed_us: u64,
    /// On results that others had brought before.
    pub duplicate_us: u64,
}

impl Spent {
    /// Slot time without a job, or with one that was lost \[us\].
    pub const fn idle_us(&self) -> u64 {
        self.connected_us
            .saturating_sub(self.useful_us)
            .saturating_sub(self.failed_us)
            .saturating_sub(self.duplicate_us)
    }

    /// Adds another account.
    pub const fn add(&mut self, other: &Self) {
        self.connected_us += other.connected_us;
        self.useful_us += other.useful_us;
        self.failed_us += other.failed_us;
        self.duplicate_us += other.duplicate_us;
    }
}
