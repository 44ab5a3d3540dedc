//! One admitted worker: what it holds, and how its slots spent their time.
use super::slot_time::{Clocks, SlotTime, Use, micros};
use protocol::{
    announce::Announcement,
    event::{Spent, WorkerAccount},
    id::{JobId, WorkerId},
    message::Attempt,
};
use std::time::Duration;

/// A job in the hands of a worker.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lease {
    pub(super) attempt: Attempt,
    /// When it was last sent.
    pub(super) sent: Duration,
    /// When the worker first said that it computes it.
    pub(super) running: Option<Duration>,
    pub(super) deadline: Duration,
    /// How long it has been computing, as far as the slot time of its worker is written down.
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
    /// Somebody has taken it out of the work: it gets nothing new.
    pub(super) drained: bool,
    /// Attempts it holds of jobs that were not submitted (yet).
    pub(super) claims: Vec<Attempt>,
    /// Attempts that were taken from it, and when: it may compute them until it has read so.
    pub(super) taken: Vec<(Attempt, Duration)>,
    pub(super) done: u64,
    pub(super) failed: u64,
    slot_time: SlotTime,
}

impl Member {
    /// A worker that has just been admitted.
    pub(super) fn new(announcement: Announcement, clocks: &Clocks, now: Duration) -> Self {
        Self {
            announcement,
            since: now,
            heard: now,
            ready: false,
            leases: Vec::new(),
            alone: false,
            drained: false,
            claims: Vec::new(),
            taken: Vec::new(),
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

    /// Whether it may be given a job that another may hold too.
    pub(super) const fn takes_jobs(&self) -> bool {
        self.ready && !self.alone && !self.drained
    }

    /// How many slots have nothing to compute.
    pub(super) fn idle(&self) -> usize {
        self.slots().saturating_sub(self.leases.len())
    }

    pub(super) fn add_lease(&mut self, lease: Lease, clocks: &Clocks) {
        self.settle(clocks);
        let prompt = self.idle() > 0;
        self.leases.push(Lease { prompt, ..lease });
    }

    pub(super) fn drop_lease(&mut self, job: JobId, clocks: &Clocks) -> Option<Lease> {
        self.settle(clocks);
        let at = self
            .leases
            .iter()
            .position(|lease| lease.attempt.job == job)?;
        let lease = self.leases.remove(at);
        self.alone &= !self.leases.is_empty();
        Some(lease)
    }

    /// From now on it can be given jobs, or cannot.
    pub(super) fn set_ready(&mut self, ready: bool, clocks: &Clocks) {
        if self.ready != ready {
            self.settle(clocks);
            self.ready = ready;
        }
    }

    /// Writes down what happened since the last time; to be called before the number of jobs it
    /// computes, or its readiness, changes.
    pub(super) fn settle(&mut self, clocks: &Clocks) {
        let (passed, slots) = (self.slot_time.unwritten(clocks), self.slots());
        self.slot_time = self.settled(clocks);
        for lease in self.leases.iter_mut().take(slots) {
            lease.held += passed;
        }
    }

    fn settled(&self, clocks: &Clocks) -> SlotTime {
        let idle = u32::try_from(self.idle()).unwrap_or(u32::MAX);
        self.slot_time.until(clocks, idle, self.ready)
    }

    /// Names what an attempt that is over was.
    pub(super) fn attribute(&mut self, lease: &Lease, what: Use) {
        let spent = what
            .said()
            .map_or(lease.held, |said| self.possible(lease, said));
        self.slot_time.add(what, spent);
    }

    /// All it computes is lost with it.
    pub(super) fn lose_leases(&mut self, clocks: &Clocks) {
        self.settle(clocks);
        for lease in &mut self.leases {
            self.slot_time.add(Use::Lost, lease.held);
            lease.held = Duration::ZERO;
        }
    }

    /// How much of the time that the worker says it can have spent, as far as is known here.
    ///
    /// Orders may arrive in another order than they were sent in, so that another lease was held to
    /// be computed meanwhile; time is taken from there, never made.
    fn possible(&mut self, lease: &Lease, said: Duration) -> Duration {
        let mut found = lease.held + self.slot_time.on_the_way;
        for other in &mut self.leases {
            let missing = said.saturating_sub(found).min(other.held);
            other.held -= missing;
            found += missing;
        }
        let spent = said.min(found);
        self.slot_time.on_the_way = found.saturating_sub(spent);
        spent
    }

    /// How its slots spent their time until now; what they compute is held to be useful.
    pub(super) fn spent(&self, clocks: &Clocks) -> Spent {
        let passed = self.slot_time.unwritten(clocks);
        let computing = self.leases.iter().take(self.slots());
        let computing: Duration = computing.map(|lease| lease.held + passed).sum();
        let connected = micros(clocks.now.saturating_sub(self.since));
        let connected_us = connected.saturating_mul(u64::from(self.announcement.slots));
        self.settled(clocks).stated(connected_us, computing)
    }

    /// Its row in the account of slot time, until now.
    pub(super) fn row(&self, worker: WorkerId, clocks: &Clocks) -> WorkerAccount {
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
