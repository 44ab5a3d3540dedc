//! State of the scheduler core, and queries on it that do not depend on how the state changes.
use super::{
    failures::Failures,
    input::{Command, Drain},
    job_set::JobSet,
    member::Member,
    notice::Notice,
    policy::Policy,
    slot_time::Clocks,
    times::JobDurations,
    unclaimed_results::UnclaimedResults,
};
use journal::event::{Account, Event, Spent, WorkerAccount};
use journal::job_range::is_part;
use protocol::{
    case::Reproducibility,
    id::{ContentHash, JobId, RunId, WorkerId},
    job::Job,
    message::{Attempt, ToWorker},
    proof::ReferenceResult,
};
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
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
    pub repeats: Reproducibility,
    /// Expected result of the case's reference individual, which workers simulate to prove their numerics;
    /// `None` until the first worker has delivered its own.
    pub proof: Option<ReferenceResult>,
    /// Jobs whose results are in the journal.
    pub finished: JobSet,
    /// Workers that outlived the previous coordinator process and may hold jobs and results of it.
    pub expected: BTreeSet<WorkerId>,
    /// Time limits and retry limits of the scheduler.
    pub policy: Policy,
}

/// Scheduler state machine: jobs, workers and leases of one coordinator process.
#[derive(Debug)]
pub struct Core {
    pub(super) options: CoreOptions,
    pub(super) members: BTreeMap<WorkerId, Member>,
    pub(super) refused: BTreeSet<WorkerId>,
    /// Drained workers, including those currently disconnected, with the options of their drain.
    pub(super) drained: BTreeMap<WorkerId, Drain>,
    pub(super) jobs: BTreeMap<JobId, Pending>,
    pub(super) queue: BTreeSet<JobId>,
    /// Pending jobs that are anticipated, waiting or held by a worker.
    pub(super) anticipated: BTreeSet<JobId>,
    /// Anticipated jobs that no worker holds, likeliest first.
    pub(super) anticipated_queue: VecDeque<JobId>,
    /// Anticipated jobs with a result, each with the worker that computed it and the slot time it took.
    pub(super) computed_ahead: BTreeMap<JobId, (WorkerId, Duration)>,
    /// Quarantined jobs: pending jobs that must run alone on a worker because workers holding them were lost.
    pub(super) suspects: BTreeSet<JobId>,
    /// Jobs with an accepted result not yet stored in the journal, each with the attempts to acknowledge once
    /// it is.
    pub(super) storing: BTreeMap<JobId, Vec<(WorkerId, Attempt)>>,
    pub(super) finished: JobSet,
    /// Results of jobs that were not submitted (yet).
    pub(super) unclaimed: UnclaimedResults,
    pub(super) times: JobDurations,
    pub(super) counts: Counts,
    pub(super) last_call: Duration,
    /// Time until which broken connections are attributed to a stall of the coordinator and not counted as
    /// losses.
    pub(super) reconnect_grace_until: Duration,
    /// Time since which jobs have waited without any worker.
    pub(super) no_worker_since: Option<Duration>,
    pub(super) no_worker_notified: bool,
    /// Time since which no job but those that wait for a new worker is left; `None` if the run makes progress.
    pub(super) waiting_since: Option<Duration>,
    /// Model effects that all workers must support; `None` until the first worker joins.
    pub(super) effects: Option<Vec<String>>,
    pub(super) clocks: Clocks,
    /// Moving average of the overhead per job: time from the order to an idle slot until the result, less the
    /// computing time.
    pub(super) latency: Option<Duration>,
    /// Time until which nothing is dispatched after a coordinator restart, because returning workers may
    /// already hold the jobs; `None` if there is no such wait.
    pub(super) rejoin_until: Option<Duration>,
    /// Whether dispatch is paused because the journal cannot be written.
    pub(super) paused: bool,
    /// Time of the last slot-time account.
    pub(super) last_account: Duration,
    pub(super) phase: Phase,
    pub(super) commands: Vec<Command>,
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

/// Running totals of the run for progress reports: losses, failures, successes, repeats, copies, duplicates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) lost: u32,
    pub(super) failed: u32,
    pub(super) succeeded: u64,
    pub(super) repeated: u32,
    pub(super) copies: u32,
    pub(super) duplicates: u64,
    /// Slot time by use of workers that have left or were lost.
    pub(super) departed_slot_time: Spent,
}

/// A job without an accepted result.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) job: Job,
    pub(super) work: ContentHash,
    /// Number of the job's next attempt in this coordinator process, from 0.
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
    /// Creates a scheduler core without workers and jobs.
    pub fn new(mut options: CoreOptions) -> Self {
        let finished = mem::take(&mut options.finished);
        Self {
            options,
            members: BTreeMap::new(),
            refused: BTreeSet::new(),
            drained: BTreeMap::new(),
            jobs: BTreeMap::new(),
            queue: BTreeSet::new(),
            anticipated: BTreeSet::new(),
            anticipated_queue: VecDeque::new(),
            computed_ahead: BTreeMap::new(),
            suspects: BTreeSet::new(),
            storing: BTreeMap::new(),
            finished,
            unclaimed: UnclaimedResults::default(),
            times: JobDurations::default(),
            counts: Counts::default(),
            last_call: Duration::ZERO,
            reconnect_grace_until: Duration::ZERO,
            no_worker_since: None,
            no_worker_notified: false,
            waiting_since: None,
            effects: None,
            clocks: Clocks::default(),
            latency: None,
            rejoin_until: None,
            paused: false,
            last_account: Duration::ZERO,
            phase: Phase::Open,
            commands: Vec::new(),
        }
    }

    /// Returns whether the job has an accepted result, stored or about to be.
    pub fn has_finished(&self, job: JobId) -> bool {
        self.finished.contains(job) || self.storing.contains_key(&job)
    }

    /// Returns whether a job is a part that an earlier coordinator process made and that this one has not made
    /// again by the end of the wait for the workers of that process: nobody will request it.
    pub(super) fn is_orphan(&self, job: JobId) -> bool {
        is_part(job)
            && !self.jobs.contains_key(&job)
            && self.rejoin_until.is_none()
            && self.options.expected.is_empty()
    }

    /// Returns the number of slots that would stay idle if every requested job without a result ran now.
    pub fn idle_slots(&self) -> usize {
        let ready = self.members.values().filter(|member| member.takes_jobs());
        let slots: usize = ready.map(Member::slots).sum();
        slots.saturating_sub(self.jobs.len() - self.anticipated.len())
    }

    /// Returns the number of jobs that workers hold.
    pub(super) fn held_jobs(&self) -> usize {
        self.jobs.len() - self.queue.len() - self.anticipated_queue.len()
    }

    /// Returns the number of results that workers have delivered and this process has accepted.
    pub const fn results(&self) -> u64 {
        self.counts.succeeded
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
        self.queued_jobs() == 0 && !self.jobs.is_empty() && self.may_give_out()
    }

    /// Returns whether a job waits for a worker that joins after the last loss of those that held it.
    pub(super) fn awaits_new_worker(&self, job: JobId) -> bool {
        let pending = self.jobs.get(&job);
        pending.is_some_and(|own| own.failures.awaits_new_worker(&self.options.policy))
    }

    /// Returns the number of queued jobs but those that wait for a new worker, which come after all others.
    pub(super) fn queued_jobs(&self) -> usize {
        let wait = |job: &&JobId| self.awaits_new_worker(**job);
        let waiting = self.suspects.intersection(&self.queue).filter(wait);
        self.queue.len() - waiting.count()
    }

    /// Returns whether a pending job must run alone on a worker, because several workers that held it were
    /// lost.
    pub(super) const fn must_run_alone(&self, pending: &Pending) -> bool {
        pending.failures.is_suspect(&self.options.policy)
    }

    /// Returns the deadline of the next attempt of a pending job.
    pub(super) fn deadline(&self, pending: &Pending) -> Duration {
        let overdue = pending.failures.deadlines;
        let policy = &self.options.policy;
        self.times.deadline(pending.job.kind(), overdue, policy)
    }

    /// Removes a job that has its result or is given up from the pending jobs, and returns it.
    pub(super) fn forget(&mut self, job: JobId) -> Option<Pending> {
        self.queue.remove(&job);
        self.suspects.remove(&job);
        if self.anticipated.remove(&job) {
            self.anticipated_queue.retain(|own| *own != job);
        }
        self.jobs.remove(&job)
    }

    /// Records the slot-time account of the connected workers.
    pub(super) fn account(&mut self, now: Duration) {
        self.last_account = now;
        let members = self.members.iter();
        let rows = members.map(|(id, member)| member.account_row(*id, &self.clocks));
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
        self.commands.push(Command::Record(event));
    }

    pub(super) fn send(&mut self, to: WorkerId, message: ToWorker) {
        self.commands.push(Command::Send { to, message });
    }

    pub(super) fn notice(&mut self, notice: Notice) {
        self.commands.push(Command::Notice(notice));
    }
}

/// Converts a duration to milliseconds, saturating.
pub(super) fn millis(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
