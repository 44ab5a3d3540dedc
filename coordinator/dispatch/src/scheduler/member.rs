//! One admitted worker: the leases held, and the use of its slot time.
use super::slot_time::{AttemptUse, Clocks, SlotTime, micros};
use journal::event::{Spent, WorkerAccount};
use protocol::{
    announce::Announcement,
    id::{JobId, WorkerId},
    message::Attempt,
};
use std::time::Duration;

/// Lease of one job attempt to a worker.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lease {
    pub(super) attempt: Attempt,
    /// Time at which the order to run the leased attempt was last sent to the worker.
    pub(super) sent: Duration,
    /// Time at which the worker first reported that the attempt was running.
    pub(super) running: Option<Duration>,
    pub(super) deadline: Duration,
    /// Slot time spent on the leased attempt until the worker's slot time was last brought up to date by
    /// [`Member::settle`].
    pub(super) held: Duration,
    /// Whether the worker had an idle slot when the order to run the leased attempt was sent.
    pub(super) sent_to_idle_slot: bool,
}

impl Lease {
    /// Creates the lease of an attempt that was just sent.
    pub(super) const fn new(attempt: Attempt, deadline: Duration, sent: Duration) -> Self {
        Self {
            attempt,
            sent,
            running: None,
            deadline,
            held: Duration::ZERO,
            sent_to_idle_slot: false,
        }
    }
}

/// Worker that was admitted to the run, with its leases and its slot-time account.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) announcement: Announcement,
    pub(super) joined_at: Duration,
    pub(super) last_heard: Duration,
    /// Whether the worker may be given jobs: it has the case and has proved that its results agree with those
    /// of the run.
    pub(super) ready: bool,
    /// Leases in the order in which they were sent; about the first `slots` of them are running.
    pub(super) leases: Vec<Lease>,
    /// Whether the worker holds a quarantined job and gets no other job.
    pub(super) runs_quarantined_job: bool,
    /// Whether the worker is drained, that is, gets no new jobs.
    pub(super) drained: bool,
    /// Attempts that the worker reports holding although their jobs were not (yet) submitted in this process.
    pub(super) claims: Vec<Attempt>,
    /// Attempts withdrawn from the worker, each with the time of withdrawal; the worker may still run them
    /// until it receives the cancellation.
    pub(super) revoked: Vec<(Attempt, Duration)>,
    pub(super) done: u64,
    pub(super) failed: u64,
    slot_time: SlotTime,
}

impl Member {
    /// Creates a member that has just been admitted, without leases.
    pub(super) fn new(announcement: Announcement, clocks: &Clocks, now: Duration) -> Self {
        Self {
            announcement,
            joined_at: now,
            last_heard: now,
            ready: false,
            leases: Vec::new(),
            runs_quarantined_job: false,
            drained: false,
            claims: Vec::new(),
            revoked: Vec::new(),
            done: 0,
            failed: 0,
            slot_time: SlotTime::since(clocks),
        }
    }

    pub(super) fn slots(&self) -> usize {
        self.announcement.slots as usize
    }

    pub(super) fn holds(&self, job: JobId) -> bool {
        self.leases.iter().any(|lease| lease.attempt.job == job)
    }

    /// Returns whether the worker may be given a job that needs no isolation.
    pub(super) const fn takes_jobs(&self) -> bool {
        self.ready && !self.runs_quarantined_job && !self.drained
    }

    /// Returns the number of the worker's slots without a job.
    pub(super) fn idle(&self) -> usize {
        self.slots().saturating_sub(self.leases.len())
    }

    pub(super) fn add_lease(&mut self, lease: Lease, clocks: &Clocks) {
        self.settle(clocks);
        let prompt = self.idle() > 0;
        self.leases.push(Lease {
            sent_to_idle_slot: prompt,
            ..lease
        });
    }

    pub(super) fn drop_lease(&mut self, job: JobId, clocks: &Clocks) -> Option<Lease> {
        self.settle(clocks);
        let at = self
            .leases
            .iter()
            .position(|lease| lease.attempt.job == job)?;
        let lease = self.leases.remove(at);
        self.runs_quarantined_job &= !self.leases.is_empty();
        Some(lease)
    }

    /// Sets whether the worker can be given jobs, after settling the slot time so far.
    pub(super) fn set_ready(&mut self, ready: bool, clocks: &Clocks) {
        if self.ready != ready {
            self.settle(clocks);
            self.ready = ready;
        }
    }

    /// Books the slot time since the last settlement; must be called before the number of running jobs or the
    /// readiness changes.
    pub(super) fn settle(&mut self, clocks: &Clocks) {
        let (passed, slots) = (self.slot_time.unsettled(clocks), self.slots());
        self.slot_time = self.settled(clocks);
        for lease in self.leases.iter_mut().take(slots) {
            lease.held += passed;
        }
    }

    fn settled(&self, clocks: &Clocks) -> SlotTime {
        let idle = u32::try_from(self.idle()).unwrap_or(u32::MAX);
        self.slot_time.until(clocks, idle, self.ready)
    }

    /// Books the slot time of an ended attempt under the given use.
    ///
    /// Returns the time booked.
    pub(super) fn attribute(&mut self, lease: &Lease, what: AttemptUse) -> Duration {
        let spent = what
            .reported_time()
            .map_or(lease.held, |said| self.creditable_time(lease, said));
        self.slot_time.add(what, spent);
        spent
    }

    /// Makes time that was booked for an anticipated job useful, because the job was requested.
    pub(super) fn claim(&mut self, time: Duration) {
        self.slot_time.claim(time);
    }

    /// Books the slot time of all leases as lost, because the worker was lost.
    pub(super) fn lose_leases(&mut self, clocks: &Clocks) {
        self.settle(clocks);
        for lease in &mut self.leases {
            self.slot_time.add(AttemptUse::Lost, lease.held);
            lease.held = Duration::ZERO;
        }
    }

    /// Returns the slot time that the worker reported for an ended attempt, limited to the time that the
    /// coordinator has counted for this worker.
    ///
    /// Orders may overtake each other on the network, so that part of the time was counted under another
    /// lease; the missing time is moved from there, never created.
    fn creditable_time(&mut self, lease: &Lease, said: Duration) -> Duration {
        let mut found = lease.held + self.slot_time.in_transit;
        for other in &mut self.leases {
            let missing = said.saturating_sub(found).min(other.held);
            other.held -= missing;
            found += missing;
        }
        let spent = said.min(found);
        self.slot_time.in_transit = found.saturating_sub(spent);
        spent
    }

    /// Returns the worker's slot time by use until now; running attempts count as useful.
    pub(super) fn spent(&self, clocks: &Clocks) -> Spent {
        let passed = self.slot_time.unsettled(clocks);
        let computing = self.leases.iter().take(self.slots());
        let computing: Duration = computing.map(|lease| lease.held + passed).sum();
        let connected = micros(clocks.now.saturating_sub(self.joined_at));
        let connected_us = connected.saturating_mul(u64::from(self.announcement.slots));
        self.settled(clocks).to_spent(connected_us, computing)
    }

    /// Returns the worker's row in the slot-time account, covering its time in the run until now.
    pub(super) fn account_row(&self, worker: WorkerId, clocks: &Clocks) -> WorkerAccount {
        WorkerAccount {
            worker,
            host: self.announcement.host.clone(),
            slots: self.announcement.slots,
            done: self.done,
            failed: self.failed,
            spent: self.spent(clocks),
        }
    }
}
