//! Simulated cluster on a simulated clock: the real scheduler core with simulated workers, links and time.
//!
//! Every delay, speed, fault and computing time is drawn from a seed, so that a run of hours takes a fraction
//! of a second and is reproducible. The tests of the core use it, and so do projections of how a search
//! scales.
mod event;
mod source;
mod worker;

pub use event::Fault;
pub use source::{Generations, JobSource, SimulatedDerivatives, SimulatedSearch, job};
pub use worker::{Running, SimulatedWorker, cost, outcome};

use crate::{
    runtime::{DividedJobs, PartResult},
    scheduler::{Command, Core, CoreOptions, Input, JobSet, Notice, Policy, StopReason, is_part},
};
use event::ClusterEvent;
use protocol::{
    announce::{Announcement, ModelDescriptor},
    case::Reproducibility,
    event::Event,
    id::{ContentHash, JobId, RunId, WorkerId},
    job::{Job, Outcome},
    message::{Attempt, Done, FromWorker, ToWorker},
    proof::ReferenceResult,
    wire,
};
use search::random::{Phase, Streams};
use std::{
    collections::{BTreeMap, BTreeSet},
    mem,
    time::Duration,
};

/// Kind of model of the simulated case.
pub const MODEL: &str = "model";
/// Hash of the case that every simulated worker holds.
pub const CASE: ContentHash = ContentHash([7; 32]);
/// Result of the reference individual by which every simulated worker proves its numerics.
pub const PROOF: ReferenceResult = ReferenceResult::Bits(ContentHash([8; 32]));

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

/// Simulated coordinator with its workers.
pub struct Cluster {
    /// Scheduler core of the coordinator.
    pub core: Core,
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
    /// Anticipated jobs of the source.
    divided: DividedJobs,
    /// Numbers in the source of the anticipated jobs, by their ids in the core.
    anticipated: BTreeMap<JobId, u64>,
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
        let core = Core::new(CoreOptions {
            run: RunId(1),
            epoch: 1,
            case: CASE,
            case_bytes: 1,
            model: MODEL.to_owned(),
            model_digest: None,
            repeats: Reproducibility::Bits,
            proof: None,
            finished: JobSet::default(),
            expected: BTreeSet::new(),
            policy: Policy::default(),
        });
        let mut cluster = Self {
            core,
            now: Duration::ZERO,
            setting,
            job_durations: None,
            charged: BTreeSet::new(),
            stopped: None,
            free_at: Duration::ZERO,
            divided: DividedJobs::default(),
            anticipated: BTreeMap::new(),
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
        if self.unit(2, first) < self.setting.loss {
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

    fn start(&mut self, place: u64) {
        let slow = self.setting.slow_one_in;
        let id = WorkerId(place + 1000 * self.sequence + 1);
        let is_slow = slow > 0 && place.is_multiple_of(slow);
        let slowness = if is_slow { 2.0 } else { 1.0 };
        let worker = SimulatedWorker::new(place, self.setting.slots, slowness);
        self.workers.insert(id, worker);
        let mut announcement = announcement("m");
        announcement.slots = u32::try_from(self.setting.slots).expect("few");
        self.send(ClusterEvent::Up(
            id,
            FromWorker::Announce(Box::new(announcement)),
        ));
        self.schedule(Duration::from_millis(5), ClusterEvent::Beat(id));
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
    /// If the source still needs results at that time, or the core violates an invariant.
    pub fn run(&mut self, source: &mut dyn JobSource, limit: Duration) {
        self.submit(source);
        while !source.is_done() {
            let ((time, _), what) = self.events.pop_first().expect("there is always a tick");
            assert!(
                time < limit,
                "{} results: {:?}",
                self.results.len(),
                self.core.snapshot(time)
            );
            self.now = time;
            self.process_event(what);
            assert!(self.stopped.is_none(), "{:?}", self.stopped);
            if !self.undelivered_outcomes.is_empty() {
                for (job, outcome) in mem::take(&mut self.undelivered_outcomes) {
                    source.tell(job.0, &outcome);
                    let twice = self.results.insert(job.0, outcome);
                    assert_eq!(twice, None, "job {job} was delivered twice");
                }
                self.submit(source);
            }
        }
    }

    fn submit(&mut self, source: &mut dyn JobSource) {
        for (id, job) in source.ask(self.core.idle_slots()) {
            let id = JobId(id);
            let Some(jobs) = self.divided.claim(id, &job) else {
                self.tell_core(Input::Submit { id, job });
                continue;
            };
            self.tell_core(Input::Claim { jobs });
            let result = self.divided.join_finished(id);
            self.take_joined(result);
        }
        let idle = self.core.idle_slots();
        let (numbers, jobs): (Vec<u64>, Vec<Job>) = source.anticipate(idle).into_iter().unzip();
        let numbers: BTreeMap<ContentHash, u64> =
            jobs.iter().map(Job::work_hash).zip(numbers).collect();
        let change = self.divided.anticipate(jobs, idle);
        if !change.withdrawn.is_empty() {
            let jobs = change.withdrawn;
            self.tell_core(Input::Withdraw { jobs });
        }
        for (id, job) in change.parts {
            let number = numbers.get(&job.work_hash()).copied();
            self.anticipated.insert(id, number.unwrap_or_default());
            self.tell_core(Input::Anticipate { id, job });
        }
    }

    /// Delivers and stores the result of an anticipated job that has been submitted.
    fn take_joined(&mut self, result: PartResult) {
        if let PartResult::Joined(whole) = result {
            let id = whole.job();
            self.undelivered_outcomes.push((id, whole.outcome));
            self.schedule(STORING, ClusterEvent::Stored(vec![id]));
        }
    }

    fn process_event(&mut self, what: ClusterEvent) {
        match what {
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
            ClusterEvent::Stored(jobs) => {
                let jobs = self.divided.stored(jobs);
                self.tell_core(Input::Stored { jobs });
            }
            ClusterEvent::Tick => {
                self.tell_core(Input::Tick);
                self.schedule(Duration::from_millis(250), ClusterEvent::Tick);
            }
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

    fn apply_fault(&mut self, place: u64, fault: Fault) {
        let found = self
            .workers
            .iter()
            .find(|(_, worker)| worker.place == place);
        let id = *found.expect("a place is filled").0;
        let worker = self.workers.get_mut(&id).expect("just found");
        match fault {
            Fault::Freeze => worker.frozen = true,
            Fault::Thaw => {
                worker.frozen = false;
                for what in mem::take(&mut worker.deferred_events) {
                    self.schedule(Duration::ZERO, what);
                }
            }
            Fault::Kill => {
                let dead = self.workers.remove(&id).expect("just found");
                // what it said last dies with it
                self.events
                    .retain(|_, what| !matches!(what, ClusterEvent::Up(from, _) | ClusterEvent::Heard(from, _) if *from == id));
                for running in &dead.running {
                    self.computed += self.now.saturating_sub(running.begun);
                }
                self.tell_core(Input::Disconnected { worker: id });
                self.start(place);
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
                let beat = worker.beat(Some(CASE), PROOF);
                let again: Vec<Done> = worker.outbox.values().cloned().collect();
                self.send(ClusterEvent::Up(id, FromWorker::Beat(beat)));
                for done in again {
                    self.send(ClusterEvent::Up(id, FromWorker::Done(Box::new(done))));
                }
                self.schedule(Duration::from_secs(1), ClusterEvent::Beat(id));
            }
            ClusterEvent::Down(_, ToWorker::Identify) => {
                let mut announcement = announcement("m");
                announcement.slots = u32::try_from(worker.slots).expect("few");
                self.send(ClusterEvent::Up(
                    id,
                    FromWorker::Announce(Box::new(announcement)),
                ));
            }
            ClusterEvent::Down(..)
            | ClusterEvent::Up(..)
            | ClusterEvent::Heard(..)
            | ClusterEvent::Tick
            | ClusterEvent::Stored(_)
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
        let mut storing = Vec::new();
        for command in self.core.handle(input, self.now) {
            match command {
                Command::Send { to, message } => self.send(ClusterEvent::Down(to, message)),
                Command::Store(finished) if is_part(finished.job()) => {
                    let result = self.divided.finish(*finished);
                    self.take_joined(result);
                }
                Command::Store(finished) => storing.push(finished.job()),
                Command::Deliver(done) if is_part(done.id) => {}
                Command::Deliver(done) => self.undelivered_outcomes.push((done.id, done.outcome)),
                Command::Record(event @ Event::Accounted(_)) => self.accounts.push(event),
                Command::Record(_) => {}
                Command::Notice(notice) => self.notices.push(notice),
                Command::Stop(stop) => self.stopped = Some(stop),
            }
        }
        if !storing.is_empty() {
            self.schedule(STORING, ClusterEvent::Stored(storing));
        }
    }

    /// Returns the share of all slot time that went into accepted results.
    pub fn capacity_used(&self) -> f64 {
        let slots = self.setting.workers * self.setting.slots as u64;
        let all = self.now.as_secs_f64() * slots as f64;
        self.core.snapshot(self.now).spent.useful_us as f64 / 1e6 / all
    }
}
