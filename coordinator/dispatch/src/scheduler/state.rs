//! State of the scheduler core, and queries on it that do not depend on how the state changes.
use super::{
    failures::Failures,
    input::{Command, Drain},
    job_set::JobSet,
    member::Member,
    notice::Notice,
    policy::Policy,
    slot_time::Clocks,
    times::Times,
    unclaimed_results::UnclaimedResults,
};
use protocol::{
    case::Repeats,
    event::{Account, Event, Spent, WorkerAccount},
    id::{ContentHash, JobId, RunId, WorkerId},
    job::Job,
    message::{Attempt, ToWorker},
    proof::Proof,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    mem,
    time::Duration,
};

/// Options with which a [`Core`] is created.
#[derive(Clone, Debug)]
pub struct CoreOptions {
    /// Identifier of the run.
    pub run: RunId,
    /// Number of the coordinator process within the run, from 1; distinguishes attempts of different
    /// processes.
    pub epoch: u32,
    /// Hash of the case that workers must hold.
    pub case: ContentHash,
    /// Length of the case \[bytes\].
    pub case_bytes: u64,
    /// Kind of the case's model, which workers must be able to simulate; empty if the run simulates nothing.
    pub model: String,
    /// Digest of the model's numerics that all workers of the run must share; `None` until the first worker
    /// joins.
    pub model_digest: Option<String>,
    /// Repeatability of results across machines (bitwise, within a tolerance, or unknown).
    pub repeats: Repeats,
    /// Expected result of the case's reference individual; `None` until the first worker has proved its own.
    pub proof: Option<Proof>,
    /// Jobs whose results are in the journal.
    pub finished: JobSet,
    /// Workers that outlived the previous coordinator process and may hold jobs and results of it.
    pub expected: BTreeSet<WorkerId>,
    /// Time and retry limits.
    pub policy: Policy,
}

/// Scheduler state machine.
#[derive(Debug)]
pub struct Core {
    pub(super) options: CoreOptions,
    pub(super) members: BTreeMap<WorkerId, Member>,
    pub(super) refused: BTreeSet<WorkerId>,
    /// Drained workers, including those currently disconnected, with the way of draining.
    pub(super) drained: BTreeMap<WorkerId, Drain>,
    pub(super) jobs: BTreeMap<JobId, Pending>,
    pub(super) queue: BTreeSet<JobId>,
    /// Pending jobs that must run alone.
    pub(super) suspects: BTreeSet<JobId>,
    /// Jobs with an accepted result that is not yet stored, and the attempts to acknowledge after that.
    pub(super) storing: BTreeMap<JobId, Vec<(WorkerId, Attempt)>>,
    pub(super) finished: JobSet,
    /// Results of jobs that were not submitted (yet).
    pub(super) unclaimed: UnclaimedResults,
    pub(super) times: Times,
    pub(super) counts: Counts,
    pub(super) last_call: Duration,
    /// Time until which a broken connection is attributed to a stall of this process.
    pub(super) excused: Duration,
    /// Time since which jobs have waited without any worker.
    pub(super) deserted_since: Option<Duration>,
    pub(super) told_deserted: bool,
    /// Effects that all workers must support; `None` until the first worker joins.
    pub(super) effects: Option<Vec<String>>,
    pub(super) clocks: Clocks,
    /// Moving average of the time from an order to an idle slot until its result, less the time in the slot.
    pub(super) latency: Option<Duration>,
    /// Time until which nothing is dispatched, because workers of the previous process may already hold the
    /// jobs.
    pub(super) rejoining: Option<Duration>,
    /// Whether dispatch is paused because the journal cannot be written.
    pub(super) paused: bool,
    /// Time of the last slot-time account.
    pub(super) accounted: Duration,
    pub(super) phase: Phase,
    pub(super) out: Vec<Command>,
}

/// Phase of the run in this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Jobs are dispatched.
    Open,
    /// No more jobs are dispatched; accepted results are still written.
    Finishing,
    /// Workers have been notified of the end of the run.
    Closed,
}

/// Running totals.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) lost: u32,
    pub(super) failed: u32,
    pub(super) succeeded: u64,
    pub(super) repeated: u32,
    pub(super) copies: u32,
    pub(super) duplicates: u64,
    /// Slot time of workers that have left or were lost.
    pub(super) past: Spent,
}

/// A job without an accepted result.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) job: Job,
    pub(super) work: ContentHash,
    /// Number of the next attempt within this coordinator process.
    pub(super) next: u32,
    /// Workers that currently hold the job.
    pub(super) holders: Vec<WorkerId>,
    pub(super) refused_by: BTreeSet<WorkerId>,
    /// Workers at which an attempt crashed or ran past its deadline.
    pub(super) failed_at: BTreeSet<WorkerId>,
    pub(super) failures: Failures,
}

impl Pending {
    /// Creates a pending job without attempts.
    pub(super) fn new(job: Job) -> Self {
        Self {
            work: job.work_hash(),
            job,
            next: 0,
            holders: Vec::new(),
            refused_by: BTreeSet::new(),
            failed_at: BTreeSet::new(),
            failures: Failures::default(),
        }
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "what all files use lies here, what uses them all in the inbox"
)]
impl Core {
    /// Creates a core without workers and jobs.
    pub fn new(mut options: CoreOptions) -> Self {
        let finished = mem::take(&mut options.finished);
        Self {
            options,
            members: BTreeMap::new(),
            refused: BTreeSet::new(),
            drained: BTreeMap::new(),
            jobs: BTreeMap::new(),
            queue: BTreeSet::new(),
            suspects: BTreeSet::new(),
            storing: BTreeMap::new(),
            finished,
            unclaimed: UnclaimedResults::default(),
            times: Times::default(),
            counts: Counts::default(),
            last_call: Duration::ZERO,
            excused: Duration::ZERO,
            deserted_since: None,
            told_deserted: false,
            effects: None,
            clocks: Clocks::default(),
            latency: None,
            rejoining: None,
            paused: false,
            accounted: Duration::ZERO,
            phase: Phase::Open,
            out: Vec::new(),
        }
    }

    /// Returns whether the job has an accepted result, stored or about to be.
    pub fn has_finished(&self, job: JobId) -> bool {
        self.finished.contains(job) || self.storing.contains_key(&job)
    }

    /// Returns the number of accepted results not yet stored.
    pub fn unstored(&self) -> usize {
        self.storing.len()
    }

    /// Returns whether jobs may be dispatched: the run is open, the journal is writable and the unstored
    /// results are below the limit, so that a full or slow disk does not fill the memory.
    pub(super) fn may_give_out(&self) -> bool {
        !self.paused
            && self.phase == Phase::Open
            && self.storing.len() < self.options.policy.most_unstored
    }

    /// Returns whether idle slots wait only for running jobs: all requested jobs are dispatched.
    pub(super) fn waits_for_others(&self) -> bool {
        self.queue.is_empty() && !self.jobs.is_empty() && self.may_give_out()
    }

    /// Returns whether a pending job must run alone.
    pub(super) const fn must_run_alone(&self, pending: &Pending) -> bool {
        pending.failures.is_suspect(&self.options.policy)
    }

    /// Returns the deadline of the next attempt of a pending job.
    pub(super) fn deadline(&self, pending: &Pending) -> Duration {
        let overdue = pending.failures.deadlines;
        let policy = &self.options.policy;
        self.times.deadline(pending.job.kind(), overdue, policy)
    }

    /// Removes a job that has its result or is given up.
    pub(super) fn forget(&mut self, job: JobId) -> Option<Pending> {
        self.queue.remove(&job);
        self.suspects.remove(&job);
        self.jobs.remove(&job)
    }

    /// Records the slot-time account of the connected workers.
    pub(super) fn account(&mut self, now: Duration) {
        self.accounted = now;
        let members = self.members.iter();
        let rows = members.map(|(id, member)| member.row(*id, &self.clocks));
        let rows = rows.collect();
        self.record_account(rows, now);
    }

    pub(super) fn record_account(&mut self, workers: Vec<WorkerAccount>, now: Duration) {
        if workers.is_empty() {
            return;
        }
        let account = Account {
            epoch: self.options.epoch,
            at_ms: millis(now),
            workers,
        };
        self.record(Event::Accounted(Box::new(account)));
    }

    pub(super) fn record(&mut self, event: Event) {
        self.out.push(Command::Record(event));
    }

    pub(super) fn send(&mut self, to: WorkerId, message: ToWorker) {
        self.out.push(Command::Send { to, message });
    }

    pub(super) fn notice(&mut self, notice: Notice) {
        self.out.push(Command::Notice(notice));
    }
}

/// Converts a duration to milliseconds, saturating.
pub(super) fn millis(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
