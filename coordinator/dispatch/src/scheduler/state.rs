//! All that the core remembers, and what can be said of it without knowing how it comes about.
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

/// What a core is begun with.
#[derive(Clone, Debug)]
pub struct CoreOptions {
    /// The run.
    pub run: RunId,
    /// Which process of the run, from 1: keeps attempts of different processes apart.
    pub epoch: u32,
    /// The case that workers must hold.
    pub case: ContentHash,
    /// Its length (bytes).
    pub case_bytes: u64,
    /// Kind of the case's model, which workers must simulate; empty where nothing is simulated.
    pub model: String,
    /// Numerics of it that all workers of this run must have; none before the first.
    pub model_digest: Option<String>,
    /// How equal results of equal jobs are on all machines.
    pub repeats: Repeats,
    /// What the case's reference individual must come to; none before the first worker.
    pub proof: Option<Proof>,
    /// Jobs whose results are in the journal.
    pub finished: JobSet,
    /// Workers that outlived the last process and may hold jobs and results of it.
    pub expected: BTreeSet<WorkerId>,
    /// Times and limits.
    pub policy: Policy,
}

/// The state machine.
#[derive(Debug)]
pub struct Core {
    pub(super) options: CoreOptions,
    pub(super) members: BTreeMap<WorkerId, Member>,
    pub(super) refused: BTreeSet<WorkerId>,
    /// Whom somebody has taken out of the work, also while it is away.
    pub(super) drained: BTreeMap<WorkerId, Drain>,
    pub(super) jobs: BTreeMap<JobId, Pending>,
    pub(super) queue: BTreeSet<JobId>,
    /// Pending jobs that must run alone.
    pub(super) suspects: BTreeSet<JobId>,
    /// Accepted, not yet stored: whom to acknowledge.
    pub(super) storing: BTreeMap<JobId, Vec<(WorkerId, Attempt)>>,
    pub(super) finished: JobSet,
    /// Results of jobs that were not submitted (yet).
    pub(super) unclaimed: UnclaimedResults,
    pub(super) times: Times,
    pub(super) counts: Counts,
    pub(super) last_call: Duration,
    /// Until when a broken connection is nobody's fault but that of this process, which stood still.
    pub(super) excused: Duration,
    /// Since when jobs have waited without any worker.
    pub(super) deserted_since: Option<Duration>,
    pub(super) told_deserted: bool,
    /// Effects that all workers must know; none before the first.
    pub(super) effects: Option<Vec<String>>,
    pub(super) clocks: Clocks,
    /// From an order to a slot without a job, to its result, less the time in the slot: an average
    /// over the last few.
    pub(super) latency: Option<Duration>,
    /// Until when nothing is given out, because workers that outlived the last process may have it.
    pub(super) rejoining: Option<Duration>,
    /// The journal cannot be written.
    pub(super) paused: bool,
    /// When the account of slot time was last written down.
    pub(super) accounted: Duration,
    pub(super) phase: Phase,
    pub(super) out: Vec<Command>,
}

/// How far a run has come in this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Jobs are given out.
    Open,
    /// Nothing more is given out; what is accepted is still written.
    Finishing,
    /// Workers have been told of the end.
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
    /// Slot time of workers that went.
    pub(super) past: Spent,
}

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
    /// Workers at which an attempt crashed or ran past its deadline.
    pub(super) failed_at: BTreeSet<WorkerId>,
    pub(super) failures: Failures,
}

impl Pending {
    /// A job that nobody has been given.
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
    /// Begins without workers and jobs.
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

    /// Whether the job has its result, stored or about to be.
    pub fn has_finished(&self, job: JobId) -> bool {
        self.finished.contains(job) || self.storing.contains_key(&job)
    }

    /// Results that are not yet stored.
    pub fn unstored(&self) -> usize {
        self.storing.len()
    }

    /// Whether what comes of new orders is wanted and can be written down: a disk that is full, or
    /// slower than the workers, must not fill the memory instead.
    pub(super) fn may_give_out(&self) -> bool {
        !self.paused
            && self.phase == Phase::Open
            && self.storing.len() < self.options.policy.most_unstored
    }

    /// Whether idle slots wait for what others compute: everything asked for is given out.
    pub(super) fn waits_for_others(&self) -> bool {
        self.queue.is_empty() && !self.jobs.is_empty() && self.may_give_out()
    }

    /// Whether a pending job must run alone.
    pub(super) const fn must_run_alone(&self, pending: &Pending) -> bool {
        pending.failures.is_suspect(&self.options.policy)
    }

    /// How long the next attempt of a pending job may take.
    pub(super) fn deadline(&self, pending: &Pending) -> Duration {
        let overdue = pending.failures.deadlines;
        let policy = &self.options.policy;
        self.times.deadline(pending.job.kind(), overdue, policy)
    }

    /// Forgets a job: it has its result, or never will.
    pub(super) fn forget(&mut self, job: JobId) -> Option<Pending> {
        self.queue.remove(&job);
        self.suspects.remove(&job);
        self.jobs.remove(&job)
    }

    /// Writes down how the present workers spent their time.
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

/// As milliseconds on the wire.
pub(super) fn millis(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
