//! The state machine that leases jobs to workers: no sockets, no files, no clock.
//!
//! ```text
//! Submit -> queued -> leased -> result accepted -> stored -> acknowledged
//!             ^         |  (lost, overdue, crashed: offered again, within limits)
//!             +---------+
//! ```
//!
//! Jobs are pure functions, so the first result of a job is *the* result, whoever brings it and
//! however late; further ones are acknowledged and dropped. A result is delivered as soon as it
//! is accepted but acknowledged only once it is stored: a worker forgets nothing that a crash of
//! this process could lose.
mod account;
mod admission;
mod assign;
mod early;
mod input;
mod job_set;
mod membership;
mod notice;
mod policy;
mod reconcile;
mod result;
mod snapshot;
mod state;
mod tail;
#[cfg(test)]
mod tests;

pub use assign::offered;
pub use input::{Command, Input};
pub use job_set::JobSet;
pub use notice::{Notice, Stop};
pub use policy::Policy;
pub use snapshot::{Snapshot, WorkerSnapshot};

use account::Clocks;
use protocol::{
    event::{Account, Event, Spent, WorkerAccount},
    id::{ContentHash, JobId, RunId, WorkerId},
    job::Job,
    message::{Attempt, ToWorker},
    wire,
};
use state::{Member, Pending};
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
    /// Numerics that all workers of this run must have; none before the first.
    pub model_digest: Option<String>,
    /// What the case's reference individual must come to; none before the first worker.
    pub proof: Option<ContentHash>,
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
    options: CoreOptions,
    members: BTreeMap<WorkerId, Member>,
    refused: BTreeSet<WorkerId>,
    jobs: BTreeMap<JobId, Pending>,
    queue: BTreeSet<JobId>,
    /// Pending jobs that must run alone.
    suspects: BTreeSet<JobId>,
    /// Accepted, not yet stored: whom to acknowledge.
    storing: BTreeMap<JobId, Vec<(WorkerId, Attempt)>>,
    finished: JobSet,
    /// Results of jobs that were not submitted (yet).
    early: early::Early,
    times: policy::Times,
    counts: Counts,
    last_call: Duration,
    /// Until when a broken connection is nobody's fault but that of this process, which stood still.
    excused: Duration,
    lonely_since: Option<Duration>,
    told_lonely: bool,
    /// Effects that all workers must know; none before the first.
    effects: Option<Vec<String>>,
    clocks: Clocks,
    /// From an order to a slot without a job, to its result, less the time in the slot: an average
    /// over the last few.
    latency: Option<Duration>,
    /// Until when nothing is given out, because workers that outlived the last process may have it.
    reunion: Option<Duration>,
    /// The journal cannot be written.
    paused: bool,
    accounted: Duration,
    phase: Phase,
    out: Vec<Command>,
}

/// How far a run has come in this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Jobs are given out.
    Open,
    /// Nothing more is given out; what is accepted is still written.
    Finishing,
    /// Workers have been told of the end.
    Closed,
}

/// Running totals.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    lost: u32,
    failed: u32,
    succeeded: u64,
    repeated: u32,
    copies: u32,
    duplicates: u64,
    past: Spent,
}

impl Core {
    /// Begins without workers and jobs.
    pub fn new(mut options: CoreOptions) -> Self {
        let finished = mem::take(&mut options.finished);
        Self {
            options,
            members: BTreeMap::new(),
            refused: BTreeSet::new(),
            jobs: BTreeMap::new(),
            queue: BTreeSet::new(),
            suspects: BTreeSet::new(),
            storing: BTreeMap::new(),
            finished,
            early: early::Early::default(),
            times: policy::Times::default(),
            counts: Counts::default(),
            last_call: Duration::ZERO,
            excused: Duration::ZERO,
            lonely_since: None,
            told_lonely: false,
            effects: None,
            clocks: Clocks::default(),
            latency: None,
            reunion: None,
            paused: false,
            accounted: Duration::ZERO,
            phase: Phase::Open,
            out: Vec::new(),
        }
    }

    /// Takes note of something at a time since any fixed moment; what follows from it must be
    /// done in order.
    pub fn handle(&mut self, input: Input, now: Duration) -> Vec<Command> {
        self.clocks.advance(now);
        membership::forgive_stall(self, now);
        match input {
            Input::Submit { id, job } => self.submit(id, job, now),
            Input::Heard { from, message } => membership::heard(self, from, message, now),
            Input::Stranger { from } => self.send(from, ToWorker::Identify),
            Input::OtherVersion { from, version } => {
                admission::other_version(self, from, version);
            }
            Input::Gone { worker } => membership::gone(self, worker, now),
            Input::Stored { jobs } => result::stored(self, jobs),
            Input::Slept { time } => membership::excuse(self, time, now),
            Input::Tick => {
                membership::check_silence(self, now);
                assign::check_overdue(self, now);
                membership::check_lonely(self, now);
                tail::copy_slow(self, now);
                if now.saturating_sub(self.accounted) >= self.options.policy.account {
                    self.account(now);
                }
            }
            Input::Finish => self.phase = Phase::Finishing,
            Input::Writable(writable) => self.paused = !writable,
            Input::Close => {
                let members: Vec<WorkerId> = self.members.keys().copied().collect();
                for to in members {
                    self.send(to, ToWorker::Ended);
                }
                self.account(now);
                self.phase = Phase::Closed;
            }
        }
        if self.may_give_out() && membership::is_complete(self, now) {
            assign::assign(self, now);
        }
        let waits = self.clocks_wait();
        self.clocks.set_waiting(waits);
        mem::take(&mut self.out)
    }

    /// Whether what comes of new orders is wanted and can be written down: a disk that is full, or
    /// slower than the workers, must not fill the memory instead.
    fn may_give_out(&self) -> bool {
        !self.paused
            && self.phase == Phase::Open
            && self.storing.len() < self.options.policy.unstored
    }

    /// Whether idle slots wait for what others compute: everything asked for is given out.
    fn clocks_wait(&self) -> bool {
        self.queue.is_empty() && !self.jobs.is_empty() && self.may_give_out()
    }

    /// Writes down how the present workers spent their time.
    fn account(&mut self, now: Duration) {
        self.accounted = now;
        let workers: Vec<WorkerAccount> = self
            .members
            .iter()
            .map(|(id, member)| membership::row(*id, member, &self.clocks))
            .collect();
        self.record_account(workers, now);
    }

    fn record_account(&mut self, workers: Vec<WorkerAccount>, now: Duration) {
        if workers.is_empty() {
            return;
        }
        let account = Account {
            epoch: self.options.epoch,
            at_ms: u64::try_from(now.as_millis()).unwrap_or(u64::MAX),
            workers,
        };
        let event = Event::Accounted(Box::new(account));
        self.out.push(Command::Record(event));
    }

    /// Whether the job has its result, stored or about to be.
    pub fn has_finished(&self, job: JobId) -> bool {
        self.finished.contains(job) || self.storing.contains_key(&job)
    }

    /// Results that are not yet stored.
    pub fn unstored(&self) -> usize {
        self.storing.len()
    }

    /// The state at a time.
    pub fn snapshot(&self, now: Duration) -> Snapshot {
        let mut spent = self.counts.past;
        let mut clocks = self.clocks;
        clocks.advance(now);
        let mut workers = Vec::with_capacity(self.members.len());
        for (id, member) in &self.members {
            let account = account::statement(member, &clocks);
            spent.add(&account);
            workers.push(WorkerSnapshot {
                id: *id,
                host: member.announcement.host.clone(),
                slots: member.announcement.slots,
                busy: u32::try_from(member.leases.len().min(member.slots())).unwrap_or(u32::MAX),
                done: member.done,
                failed: member.failed,
                spent: account,
            });
        }
        Snapshot {
            workers,
            queued: self.queue.len(),
            running: self.jobs.len() - self.queue.len(),
            done: self.finished.len() + self.storing.len(),
            lost: self.counts.lost,
            failed: self.counts.failed,
            repeated: self.counts.repeated,
            copies: self.counts.copies,
            duplicates: self.counts.duplicates,
            spent,
            paused: self.paused,
        }
    }

    fn submit(&mut self, id: JobId, job: Job, now: Duration) {
        if self.has_finished(id) || self.jobs.contains_key(&id) {
            return;
        }
        let work = work_hash(&job);
        let pending = Pending {
            job,
            work,
            next: 0,
            holders: Vec::new(),
            refused_by: BTreeSet::new(),
            failures: policy::Failures::default(),
        };
        self.jobs.insert(id, pending);
        self.queue.insert(id);
        reconcile::adopt(self, id, now);
        if let Some((from, done)) = self.early.take(id) {
            result::done(self, from, done, now);
        }
    }

    fn send(&mut self, to: WorkerId, message: ToWorker) {
        self.out.push(Command::Send { to, message });
    }

    fn notice(&mut self, notice: Notice) {
        self.out.push(Command::Notice(notice));
    }
}

/// The name of a piece of work: the hash of its encoded job.
pub fn work_hash(job: &Job) -> ContentHash {
    // a job that cannot be encoded cannot be sent either; all of those share one name
    ContentHash::of(&wire::encode(job).unwrap_or_default())
}
