//! Simulated worker: jobs held, and reactions to messages.
use super::event::ClusterEvent;
use protocol::{
    id::ContentHash,
    job::{Answer, Column, Counters, Derivative, Evaluation, Failure, Job, Outcome, Per, Verdict},
    message::{Assignment, Attempt, Cost, Done, Heartbeat},
    proof::ReferenceResult,
};
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    time::Duration,
};

/// Result of the reference individual by which a sound simulated worker proves its numerics.
pub const PROOF: ReferenceResult = ReferenceResult::Bits(ContentHash([8; 32]));

/// Attempt running in a slot.
pub struct Running {
    attempt: Attempt,
    job: Job,
    /// Time at which the attempt started.
    pub begun: Duration,
}

impl Running {
    /// Returns the delay that a job of kind `Nothing` requests; zero for jobs of all other kinds.
    pub fn delay(&self) -> Duration {
        match self.job {
            Job::Nothing { delay_ms, .. } => Duration::from_millis(u64::from(delay_ms)),
            Job::Simulate(_) | Job::Own { .. } | Job::Describe => Duration::ZERO,
        }
    }
}

/// Builds the cost of an attempt that spent all its time in the slot computing.
pub const fn cost(wall_us: u64) -> Cost {
    Cost {
        wall_us,
        cpu_us: wall_us,
    }
}

/// Returns the outcome of a `Nothing` job, or of a simulation with a residual, whose fitness and derivatives follow
/// from the content of the job; jobs of other kinds are refused.
pub fn outcome(job: &Job) -> Outcome {
    let number = |content: &[u8]| {
        let [a, b, c, d, ..] = ContentHash::of(content).0;
        u32::from_le_bytes([a, b, c, d])
    };
    match job {
        Job::Nothing { reply_bytes, .. } => {
            Outcome::Done(Answer::Nothing(vec![1; *reply_bytes as usize]))
        }
        Job::Simulate(spec) => {
            let genes = spec.individual.genes.iter();
            let genes: Vec<u8> = genes.flat_map(|gene| gene.to_le_bytes()).collect();
            let column = |column: &Column| {
                let content = [&genes[..], column.name.as_bytes()].concat();
                Derivative::Curves {
                    per: Per::Decade,
                    curves: vec![vec![number(&content) as f32]],
                }
            };
            Outcome::Done(Answer::Scored(Evaluation {
                verdict: Verdict::Complete,
                fitness: f64::from(number(&genes)),
                channels: Vec::new(),
                residual: vec![1.0],
                columns: spec.columns.iter().map(column).collect(),
                counters: Counters::default(),
            }))
        }
        Job::Own { .. } | Job::Describe => Outcome::Failed(Failure::Refused {
            reason: "a simulated worker computes no jobs of this kind".to_owned(),
        }),
    }
}

/// Simulated worker that computes nothing: it keeps slots, orders and unacknowledged results.
pub struct SimulatedWorker {
    /// Index of the worker in the cluster; a replacement worker takes the index of its predecessor.
    pub place: u64,
    /// Number of jobs that the simulated worker runs simultaneously.
    pub slots: usize,
    /// Factor by which the worker's computing times exceed those of a worker of normal speed \[1\].
    pub slowness: f64,
    /// Attempts running in the slots.
    pub running: Vec<Running>,
    waiting: VecDeque<Assignment>,
    /// Results not yet acknowledged by the coordinator as stored.
    pub outbox: BTreeMap<Attempt, Done>,
    settled: BTreeSet<Attempt>,
    /// Whether the simulated worker is suspended (its connection stays open).
    pub frozen: bool,
    /// Events deferred while the worker is frozen.
    pub(super) deferred_events: Vec<ClusterEvent>,
    /// Whether the simulated worker was drained.
    pub(super) drained: bool,
    /// Whether the simulated worker refuses all jobs.
    pub(super) refuses: bool,
    /// Result of the reference individual on the simulated worker.
    pub(super) proof: ReferenceResult,
}

impl SimulatedWorker {
    /// Creates an idle worker.
    pub const fn new(place: u64, slots: usize, slowness: f64) -> Self {
        Self {
            place,
            slots,
            slowness,
            running: Vec::new(),
            waiting: VecDeque::new(),
            outbox: BTreeMap::new(),
            settled: BTreeSet::new(),
            frozen: false,
            deferred_events: Vec::new(),
            drained: false,
            refuses: false,
            proof: PROOF,
        }
    }

    /// Queues an order to run an attempt at the simulated worker, unless the attempt is already known.
    pub fn enqueue(&mut self, order: Assignment) {
        let attempt = order.attempt;
        let known = self.settled.contains(&attempt)
            || self.outbox.contains_key(&attempt)
            || self.running.iter().any(|held| held.attempt == attempt)
            || self.waiting.iter().any(|held| held.attempt == attempt);
        if !known {
            self.waiting.push_back(order);
        }
    }

    /// Starts the order that has waited longest, if a slot is free.
    pub fn begin(&mut self, now: Duration) -> Option<Attempt> {
        (self.running.len() < self.slots).then_some(())?;
        let order = self.waiting.pop_front()?;
        self.running.push(Running {
            attempt: order.attempt,
            job: order.job,
            begun: now,
        });
        Some(order.attempt)
    }

    /// Cancels an attempt and returns the computing time wasted on it.
    pub fn cancel(&mut self, attempt: Attempt, now: Duration) -> Duration {
        self.settled.insert(attempt);
        self.outbox.remove(&attempt);
        self.waiting.retain(|order| order.attempt != attempt);
        let running = self.take_running(attempt);
        running.map_or(Duration::ZERO, |running| now.saturating_sub(running.begun))
    }

    /// Ends an attempt that is still running and returns its result.
    pub fn finish(&mut self, attempt: Attempt, now: Duration) -> Option<Done> {
        let running = self.take_running(attempt)?;
        let wall = now.saturating_sub(running.begun);
        let done = Done {
            attempt,
            work: running.job.work_hash(),
            cost: cost(u64::try_from(wall.as_micros()).unwrap_or(u64::MAX)),
            outcome: if self.refuses {
                let reason = "this worker refuses all jobs".to_owned();
                Outcome::Failed(Failure::Refused { reason })
            } else {
                outcome(&running.job)
            },
        };
        self.outbox.insert(attempt, done.clone());
        Some(done)
    }

    /// Drops results of the simulated worker that the coordinator acknowledged as stored.
    pub fn settle(&mut self, attempts: Vec<Attempt>) {
        for attempt in attempts {
            self.outbox.remove(&attempt);
            self.settled.insert(attempt);
        }
    }

    /// Builds the simulated worker's heartbeat, with its case and its result of the reference individual.
    pub fn beat(&self, case: Option<ContentHash>, proof: ReferenceResult) -> Heartbeat {
        Heartbeat {
            number: 0,
            case,
            proof: Some(proof),
            running: self.running.iter().map(|held| held.attempt).collect(),
            waiting: self.waiting.iter().map(|order| order.attempt).collect(),
            finished: self.outbox.keys().copied().collect(),
        }
    }

    fn take_running(&mut self, attempt: Attempt) -> Option<Running> {
        let mut running = self.running.iter();
        let at = running.position(|running| running.attempt == attempt)?;
        Some(self.running.remove(at))
    }
}
