//! Simulated cluster on a simulated clock: the real scheduler core with simulated workers, links and time.
//!
//! Every delay, speed, fault and computing time is drawn from a seed, so that a run of hours takes a fraction
//! of a second and is reproducible. The tests of the core use it, and so do projections of how a search
//! scales. With a journal, the coordinator can be killed and started again; `faults` draws faults of all kinds and
//! checks the invariants of the scheduler after every step.
mod event;
#[cfg(test)]
mod faults;
mod injection;
mod journal;
mod source;
mod worker;

pub use event::Fault;
pub use source::{Generations, JobSource, SimulatedDerivatives, SimulatedSearch, job};
pub use worker::{PROOF, Running, SimulatedWorker, cost, outcome};

use crate::{
    runtime::{Coordination, Divide, Undivided},
    scheduler::{Command, Core, CoreOptions, Input, JobSet, Notice, Policy, Snapshot, StopReason},
};
use ::journal::event::{Event, Finished};
use ::journal::job_range::is_part;
use event::ClusterEvent;
use journal::{RUN, SimulatedJournal};
use protocol::{
    announce::{Announcement, ModelDescriptor},
    case::Reproducibility,
    id::{ContentHash, JobId, WorkerId},
    job::{Failure, Job, Outcome},
    message::{Attempt, Done, FromWorker, ToWorker},
    wire,
};
use search::random::{Phase, Streams};
use std::{
    collections::{BTreeMap, BTreeSet},
    mem,
    sync::Arc,
    time::Duration,
};

/// Kind of model of the simulated case.
pub const MODEL: &str = "model";
/// Hash of the case that every simulated worker holds.
pub const CASE: ContentHash = ContentHash([7; 32]);

/// Returns the options of the core of a new run.
fn options(policy: Policy) -> CoreOptions {
    CoreOptions {
        run: RUN,
        epoch: 1,
        case: CASE,
        case_bytes: 1,
        model: MODEL.to_owned(),
        model_digest: None,
        repeats: Reproducibility::Bits,
        proof: None,
        finished: JobSet::default(),
        expected: BTreeSet::new(),
        policy,
    }
}

/// Returns whether a job has no result because workers refused it.
const fn is_refused(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Failed(Failure::Refused { .. }))
}

/// Number of workers that a job kills before it is done.
pub const KILLS: u32 = 6;

/// Time until a result is stored.
const STORING: Duration = Duration::from_micros(300);

/// Builds the announcement of a simulated worker with one slot and the given model digest.
pub fn announcement(digest: &str) -> Announcement {
    Announcement {
        protocol: wire::VERSION,
        build: concat!(env!("CARGO_PKG_VERSION"), " simulated").to_owned(),
        host: "host".to_owned(),
        pid: 3,
        slots: 1,
        cores: 8,
        job_kinds: Vec::new(),
        models: vec![ModelDescriptor {
            kind: MODEL.to_owned(),
            digest: digest.to_owned(),
            effects: Vec::new(),
        }],
    }
}

/// Configuration of a simulated cluster.
#[derive(Clone, Copy)]
pub struct ClusterSetting {
    /// Number of simulated workers in the cluster.
    pub workers: u64,
    /// Number of slots per worker.
    pub slots: usize,
    /// Seed of all random choices.
    pub seed: u64,
    /// Relative standard deviation of the computing times, lognormal about one second \[1\].
    pub spread: f64,
    /// Time that the coordinator spends on each result, sequentially.
    pub handling: Duration,
    /// One in this many workers is half as fast as the others; 0 if all are equally fast.
    pub slow_one_in: u64,
    /// Longest delay of a message.
    pub delay: Duration,
    /// Share of messages lost \[1\].
    pub loss: f64,
    /// Share of messages delivered twice \[1\].
    pub duplication: f64,
    /// Jobs that kill their worker as soon as they start, the first [`KILLS`] times.
    pub killers: &'static [u64],
}

impl ClusterSetting {
    /// Returns a configuration of equally fast workers with one slot each on a good network.
    pub const fn even(workers: u64) -> Self {
        Self {
            workers,
            slots: 1,
            seed: 1,
            spread: 0.3,
            handling: Duration::ZERO,
            slow_one_in: 0,
            delay: Duration::from_millis(2),
            loss: 0.0,
            duplication: 0.0,
            killers: &[],
        }
    }
}

/// State of the coordinator process.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Process {
    /// It was killed.
    Ended,
    /// It was started, and the source has not begun again yet.
    Started,
    Running,
}

/// Simulated coordinator with its workers.
pub struct Cluster {
    coordination: Coordination,
    /// Division of jobs by the next coordinator process.
    pub(crate) divide: Arc<dyn Divide>,
    /// Time limits and retry limits of the coordinator.
    pub(crate) policy: Policy,
    /// Journal of the coordinator; `None` if it is never killed.
    journal: Option<SimulatedJournal>,
    /// Results in the journal when the coordinator was started.
    recorded: BTreeMap<JobId, Finished>,
    /// Number of coordinator processes so far.
    pub(crate) processes: u32,
    process: Process,
    /// Workers to and from which messages are lost.
    cut_off: BTreeSet<WorkerId>,
    /// Whether the result of the reference individual is known, so that one that differs is refused.
    is_proved: bool,
    /// Current simulated time.
    pub now: Duration,
    setting: ClusterSetting,
    /// Computing time by job number, in place of the lognormal distribution.
    pub job_durations: Option<Box<dyn Fn(u64) -> Duration>>,
    /// Attempts for whose results the coordinator's simulated handling time has already been counted.
    charged: BTreeSet<Attempt>,
    /// Reason why the core stopped the run, if it did.
    stopped: Option<StopReason>,
    /// Simulated time at which the coordinator has finished handling all results that have arrived.
    free_at: Duration,
    /// Numbers in the source of the anticipated jobs, by their contents, and by their ids in the core once workers
    /// have them.
    numbers: BTreeMap<ContentHash, u64>,
    anticipated: BTreeMap<JobId, u64>,
    /// Whether the journal cannot be written.
    is_paused: bool,
    events: BTreeMap<(Duration, u64), ClusterEvent>,
    sequence: u64,
    workers: BTreeMap<WorkerId, SimulatedWorker>,
    /// Outcomes of the finished jobs, by job number.
    pub results: BTreeMap<u64, Outcome>,
    /// Outcomes delivered by the core but not yet passed to the job source.
    undelivered_outcomes: Vec<(JobId, Outcome)>,
    /// Slot-time accounts recorded by the core.
    pub accounts: Vec<Event>,
    /// Notices emitted by the core.
    pub notices: Vec<Notice>,
    /// Slot time actually spent computing, whether or not the result was used.
    pub computed: Duration,
    /// Number of attempts started.
    pub begun: u64,
    /// Number of workers that each job has killed.
    kills: BTreeMap<JobId, u32>,
}

impl Cluster {
    /// Creates a cluster whose workers are about to announce themselves.
    pub fn new(setting: ClusterSetting) -> Self {
        let policy = Policy::default();
        let mut cluster = Self {
            coordination: Coordination::new(
                Core::new(options(policy.clone())),
                Arc::new(Undivided),
            ),
            divide: Arc::new(Undivided),
            policy,
            journal: None,
            recorded: BTreeMap::new(),
            processes: 1,
            process: Process::Running,
            cut_off: BTreeSet::new(),
            is_proved: false,
            now: Duration::ZERO,
            setting,
            job_durations: None,
            charged: BTreeSet::new(),
            stopped: None,
            free_at: Duration::ZERO,
            numbers: BTreeMap::new(),
            anticipated: BTreeMap::new(),
            is_paused: false,
            events: BTreeMap::new(),
            sequence: 0,
            workers: BTreeMap::new(),
            results: BTreeMap::new(),
            undelivered_outcomes: Vec::new(),
            accounts: Vec::new(),
            notices: Vec::new(),
            computed: Duration::ZERO,
            begun: 0,
            kills: BTreeMap::new(),
        };
        for place in 0..setting.workers {
            cluster.start(place);
        }
        cluster.schedule(Duration::ZERO, ClusterEvent::Tick);
        cluster
    }

    /// Gives the coordinator a journal, so that it can be killed, and a policy.
    #[cfg(test)]
    pub(crate) fn keep_journal(&mut self, policy: Policy) {
        self.policy = policy;
        self.journal = Some(SimulatedJournal::default());
        self.open();
        self.process = Process::Running;
    }

    /// Returns the bytes of the journal.
    #[cfg(test)]
    pub(crate) fn journal_bytes(&self) -> &[u8] {
        self.journal.as_ref().map_or(&[], |journal| &journal.disk)
    }

    /// Returns the scheduler core of the coordinator.
    pub(crate) const fn core(&self) -> &Core {
        self.coordination.core()
    }

    /// Returns the scheduler core of the coordinator for changes by a test.
    #[cfg(test)]
    pub(crate) const fn core_mut(&mut self) -> &mut Core {
        self.coordination.core_mut()
    }

    /// Returns a snapshot of the scheduler's state.
    pub fn snapshot(&self) -> Snapshot {
        self.core().snapshot(self.now)
    }

    /// Schedules a fault at the simulated time `at` for the worker with index `place`; a replacement worker
    /// has the index of its predecessor.
    pub fn fault(&mut self, at: Duration, place: u64, fault: Fault) {
        self.schedule(at, ClusterEvent::Fault(place, fault));
    }

    fn unit(&self, generation: u32, index: u64) -> f64 {
        let index = usize::try_from(index).expect("small");
        let streams = Streams::new(self.setting.seed, 5);
        streams.at(generation, Phase::Initial, index).unit()
    }

    fn schedule(&mut self, delay: Duration, what: ClusterEvent) {
        self.sequence += 1;
        self.events.insert((self.now + delay, self.sequence), what);
    }

    /// Schedules the delivery of a message between worker and coordinator after a random delay, which may
    /// reorder messages; the message may be lost or duplicated.
    fn send(&mut self, what: ClusterEvent) {
        let first = self.sequence;
        let is_cut_off = match &what {
            ClusterEvent::Up(worker, _) | ClusterEvent::Down(worker, _) => {
                self.cut_off.contains(worker)
            }
            ClusterEvent::Heard(..)
            | ClusterEvent::End(..)
            | ClusterEvent::Beat(_)
            | ClusterEvent::Tick
            | ClusterEvent::Stored(_)
            | ClusterEvent::Flush
            | ClusterEvent::Unreachable(_)
            | ClusterEvent::Start
            | ClusterEvent::Fault(..) => false,
        };
        if is_cut_off || self.unit(2, first) < self.setting.loss {
            self.sequence += 1;
            return;
        }
        if self.unit(3, first) < self.setting.duplication {
            let delay = self.setting.delay.mul_f64(self.unit(1, self.sequence));
            self.schedule(delay, what.clone());
        }
        let delay = self.setting.delay.mul_f64(self.unit(1, self.sequence));
        self.schedule(delay, what);
    }

    fn start(&mut self, place: u64) -> WorkerId {
        let slow = self.setting.slow_one_in;
        let id = WorkerId(place + 1000 * self.sequence + 1);
        let is_slow = slow > 0 && place.is_multiple_of(slow);
        let slowness = if is_slow { 2.0 } else { 1.0 };
        let worker = SimulatedWorker::new(place, self.setting.slots, slowness);
        self.workers.insert(id, worker);
        self.announce(id);
        self.schedule(Duration::from_millis(5), ClusterEvent::Beat(id));
        id
    }

    /// Sends the announcement of a worker.
    fn announce(&mut self, id: WorkerId) {
        let mut announcement = announcement("m");
        announcement.slots = u32::try_from(self.setting.slots).expect("few");
        let message = FromWorker::Announce(Box::new(announcement));
        self.send(ClusterEvent::Up(id, message));
    }

    /// Returns the computing time of a job on a worker of normal speed, which depends on the job alone.
    fn time_of(&self, job: JobId) -> Duration {
        let job = self.anticipated.get(&job).map_or(job, |own| JobId(*own));
        if let Some(takes) = &self.job_durations {
            return takes(job.0);
        }
        let index = usize::try_from(job.0).expect("small");
        let mut stream = Streams::new(self.setting.seed, 6).at(0, Phase::Mutation, index);
        let sigma = libm::sqrt(libm::log(1.0 + self.setting.spread * self.setting.spread));
        Duration::from_secs_f64(libm::exp(sigma * stream.normal() - 0.5 * sigma * sigma))
    }

    /// Runs the cluster until the source of jobs needs no more results, at most up to the simulated time
    /// `limit`.
    ///
    /// # Panics
    /// If the source still needs results at that time, or the core stops the run.
    pub fn run(&mut self, source: &mut dyn JobSource, limit: Duration) {
        self.run_checked(source, limit, |cluster| {
            assert!(cluster.stopped.is_none(), "{:?}", cluster.stopped);
        });
    }

    /// Runs the cluster like [`Self::run`] and calls `check` after every step. A coordinator with a journal that the
    /// core stops, or that cannot get a result, is started again.
    ///
    /// # Panics
    /// If the source still needs results at the time `limit`.
    pub(crate) fn run_checked(
        &mut self,
        source: &mut dyn JobSource,
        limit: Duration,
        mut check: impl FnMut(&Self),
    ) {
        self.submit(source);
        while !source.is_done() {
            let ((time, _), what) = self.events.pop_first().expect("there is always a tick");
            assert!(
                time < limit,
                "{} results: {:?}",
                self.results.len(),
                self.core().snapshot(time)
            );
            self.now = time;
            self.process_event(what);
            if self.journal.is_some() && self.stopped.take().is_some() {
                self.crash(0);
            }
            check(self);
            if self.process == Process::Started {
                self.process = Process::Running;
                self.results.clear();
                assert!(source.restart(), "the source cannot begin again");
                self.submit(source);
            }
            while !self.undelivered_outcomes.is_empty() && self.is_up() {
                for (job, outcome) in mem::take(&mut self.undelivered_outcomes) {
                    if self.journal.is_some() && is_refused(&outcome) {
                        // the command ends, and the user repeats it
                        self.crash(0);
                        break;
                    }
                    source.tell(job.0, &outcome);
                    let twice = self.results.insert(job.0, outcome);
                    assert_eq!(twice, None, "job {job} was delivered twice");
                }
                if self.is_up() {
                    self.submit(source);
                }
            }
        }
    }

    fn submit(&mut self, source: &mut dyn JobSource) {
        let mut new = Vec::new();
        for (id, job) in source.ask(self.core().idle_slots()) {
            let id = JobId(id);
            match self.recorded.get(&id) {
                Some(finished) => {
                    assert_eq!(finished.work, job.work_hash(), "job {id}");
                    let outcome = finished.outcome.clone();
                    self.undelivered_outcomes.push((id, outcome));
                }
                None => new.push((id, job)),
            }
        }
        let commands = self.coordination.submit(new, self.now);
        self.execute(commands);
        let idle = self.core().idle_slots();
        let (numbers, jobs): (Vec<u64>, Vec<Job>) = source.anticipate(idle).into_iter().unzip();
        let works = jobs.iter().map(Job::work_hash);
        self.numbers.extend(works.zip(numbers));
        let commands = self.coordination.anticipate(jobs, self.now);
        self.execute(commands);
    }

    fn process_event(&mut self, what: ClusterEvent) {
        match what {
            // nobody is there to hear it
            ClusterEvent::Up(..) | ClusterEvent::Heard(..) | ClusterEvent::Stored(_)
                if !self.is_up() => {}
            ClusterEvent::Up(from, FromWorker::Done(done)) => {
                // what is said again while it waits costs next to nothing
                let busy = !self.setting.handling.is_zero();
                if busy && !self.charged.insert(done.attempt) {
                    return;
                }
                let message = FromWorker::Done(done);
                self.free_at = self.free_at.max(self.now) + self.setting.handling;
                let wait = self.free_at.saturating_sub(self.now);
                self.schedule(wait, ClusterEvent::Heard(from, message));
            }
            ClusterEvent::Up(from, message) | ClusterEvent::Heard(from, message) => {
                self.tell_core(Input::Message { from, message });
            }
            ClusterEvent::Stored(jobs) => self.tell_core(Input::Stored { jobs }),
            ClusterEvent::Flush => self.flush(),
            ClusterEvent::Tick => {
                self.tell_core(Input::Tick);
                self.schedule(Duration::from_millis(250), ClusterEvent::Tick);
            }
            ClusterEvent::Unreachable(worker) => {
                if self.cut_off.contains(&worker) {
                    self.tell_core(Input::Disconnected { worker });
                }
            }
            ClusterEvent::Start => self.open(),
            ClusterEvent::Fault(place, fault) => self.apply_fault(place, fault),
            ClusterEvent::Down(id, _) | ClusterEvent::End(id, _) | ClusterEvent::Beat(id) => {
                match self.workers.get_mut(&id) {
                    Some(worker) if worker.frozen => worker.deferred_events.push(what),
                    Some(_) => self.work(id, what),
                    None => {}
                }
            }
        }
    }

    fn work(&mut self, id: WorkerId, what: ClusterEvent) {
        let now = self.now;
        let Some(worker) = self.workers.get_mut(&id) else {
            return;
        };
        match what {
            ClusterEvent::Down(_, ToWorker::Run(order)) => worker.enqueue(*order),
            ClusterEvent::Down(_, ToWorker::Cancel(attempt)) => {
                self.computed += worker.cancel(attempt, now);
            }
            ClusterEvent::Down(_, ToWorker::Stored(attempts)) => worker.settle(attempts),
            ClusterEvent::End(_, attempt) => {
                if let Some(done) = worker.finish(attempt, now) {
                    self.computed += Duration::from_micros(done.cost.wall_us);
                    self.send(ClusterEvent::Up(id, FromWorker::Done(Box::new(done))));
                }
            }
            ClusterEvent::Beat(_) => {
                let beat = worker.beat(Some(CASE), worker.proof.clone());
                let again: Vec<Done> = worker.outbox.values().cloned().collect();
                self.send(ClusterEvent::Up(id, FromWorker::Beat(beat)));
                for done in again {
                    self.send(ClusterEvent::Up(id, FromWorker::Done(Box::new(done))));
                }
                self.schedule(Duration::from_secs(1), ClusterEvent::Beat(id));
            }
            ClusterEvent::Down(_, ToWorker::Identify) => self.announce(id),
            // the process ends, and another one is started in its place
            ClusterEvent::Down(_, ToWorker::Refused { .. }) => {
                let place = worker.place;
                self.kill(id);
                self.start(place);
            }
            ClusterEvent::Down(..)
            | ClusterEvent::Up(..)
            | ClusterEvent::Heard(..)
            | ClusterEvent::Tick
            | ClusterEvent::Stored(_)
            | ClusterEvent::Flush
            | ClusterEvent::Unreachable(_)
            | ClusterEvent::Start
            | ClusterEvent::Fault(..) => {}
        }
        self.fill(id);
    }

    fn fill(&mut self, id: WorkerId) {
        let now = self.now;
        while let Some(worker) = self.workers.get_mut(&id) {
            let Some(attempt) = worker.begin(now) else {
                return;
            };
            let (slowness, place) = (worker.slowness, worker.place);
            self.begun += 1;
            let kills = self.kills.entry(attempt.job).or_default();
            if self.setting.killers.contains(&attempt.job.0) && *kills < KILLS {
                *kills += 1;
                self.schedule(Duration::ZERO, ClusterEvent::Fault(place, Fault::Kill));
            }
            let time = self.time_of(attempt.job).mul_f64(slowness);
            self.schedule(time, ClusterEvent::End(id, attempt));
        }
    }

    fn tell_core(&mut self, input: Input) {
        if self.is_up() {
            let commands = self.coordination.handle(input, self.now);
            self.execute(commands);
        }
    }

    fn execute(&mut self, commands: Vec<Command>) {
        let mut storing = Vec::new();
        for command in commands {
            match command {
                Command::Send { to, message } => {
                    if let ToWorker::Run(order) = &message
                        && is_part(order.attempt.job)
                        && let Some(number) = self.numbers.get(&order.job.work_hash())
                    {
                        self.anticipated.insert(order.attempt.job, *number);
                    }
                    self.send(ClusterEvent::Down(to, message));
                }
                Command::Store(finished) if self.journal.is_none() => storing.push(finished.job()),
                Command::Store(finished) => self.append(&Event::Finished(finished)),
                Command::Deliver(done) => self.undelivered_outcomes.push((done.id, done.outcome)),
                Command::Record(event @ Event::Accounted(_)) => {
                    self.append(&event);
                    self.accounts.push(event);
                }
                Command::Record(event) => {
                    self.is_proved |= matches!(event, Event::Proved { .. });
                    self.append(&event);
                }
                Command::Notice(notice) => self.notices.push(notice),
                Command::Stop(stop) => self.stopped = Some(stop),
            }
        }
        if !storing.is_empty() {
            self.schedule(STORING, ClusterEvent::Stored(storing));
        }
    }

    /// Queues an event for the journal, if there is one.
    fn append(&mut self, event: &Event) {
        if let Some(journal) = &mut self.journal
            && journal.append(event)
        {
            self.schedule(STORING, ClusterEvent::Flush);
        }
    }

    /// Returns the share of all slot time that went into accepted results.
    pub fn capacity_used(&self) -> f64 {
        let slots = self.setting.workers * self.setting.slots as u64;
        let all = self.now.as_secs_f64() * slots as f64;
        self.snapshot().spent.useful_us as f64 / 1e6 / all
    }
}
