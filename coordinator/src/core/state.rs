//! What the core remembers of jobs and workers.
use super::{
    account::{Clocks, Purse, settle},
    policy::Failures,
};
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
    /// How long it has been computing, as far as the account of its worker is settled.
    pub(super) held: Duration,
    /// It was sent to a slot that had nothing to do.
    pub(super) prompt: bool,
}

impl Lease {
    /// A job that was just sent.
    pub(super) const fn new(attempt: Attempt, deadline: Duration, sent: Duration) -> Self {
        Self {
            attempt,
            sent,
            running: None,
            deadline,
            held: Duration::ZERO,
            prompt: false,
        }
    }
}

/// An admitted worker.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) announcement: Announcement,
    pub(super) since: Duration,
    pub(super) heard: Duration,
    /// It has the case, has proved that it computes as the others do, and may be given jobs.
    pub(super) ready: bool,
    /// In the order in which they were sent; about the first `slots` of them compute.
    pub(super) leases: Vec<Lease>,
    /// It holds a job in quarantine and gets nothing else.
    pub(super) alone: bool,
    /// Attempts it holds of jobs that were not submitted (yet).
    pub(super) claims: Vec<Attempt>,
    /// Attempts that were taken from it, and when: it may compute them until it has read so.
    pub(super) taken: Vec<(Attempt, Duration)>,
    pub(super) done: u64,
    pub(super) failed: u64,
    pub(super) purse: Purse,
}

impl Member {
    pub(super) fn slots(&self) -> usize {
        self.announcement.slots as usize
    }

    pub(super) fn holds(&self, job: JobId) -> bool {
        self.leases.iter().any(|lease| lease.attempt.job == job)
    }

    /// How many slots have nothing to compute.
    pub(super) fn idle(&self) -> usize {
        self.slots().saturating_sub(self.leases.len())
    }

    pub(super) fn add_lease(&mut self, lease: Lease, clocks: &Clocks) {
        settle(self, clocks);
        let prompt = self.idle() > 0;
        self.leases.push(Lease { prompt, ..lease });
    }

    pub(super) fn drop_lease(&mut self, job: JobId, clocks: &Clocks) -> Option<Lease> {
        settle(self, clocks);
        let at = self
            .leases
            .iter()
            .position(|lease| lease.attempt.job == job)?;
        let lease = self.leases.remove(at);
        self.alone &= !self.leases.is_empty();
        Some(lease)
    }
}
