//! One simulated worker: what it holds, and what it makes of what it hears.
use super::happening::What;
use protocol::{
    id::ContentHash,
    job::{Answer, Failure, Job, Outcome},
    message::{Attempt, Beat, Cost, Done, Order},
    proof::Proof,
};
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    time::Duration,
};

/// An attempt in a slot.
pub struct Running {
    attempt: Attempt,
    job: Job,
    /// When it was begun.
    pub begun: Duration,
}

impl Running {
    /// How long its job says that it takes.
    pub fn delay(&self) -> Duration {
        match self.job {
            Job::Nothing { delay_ms, .. } => Duration::from_millis(u64::from(delay_ms)),
            Job::Simulate(_) | Job::Own { .. } | Job::Describe => Duration::ZERO,
        }
    }
}

/// So long in the slot, all of it computing.
pub const fn cost(wall_us: u64) -> Cost {
    Cost {
        wall_us,
        cpu_us: wall_us,
    }
}

/// What comes of a job that does nothing; any other is refused.
pub fn outcome(job: &Job) -> Outcome {
    match job {
        Job::Nothing { reply_bytes, .. } => {
            Outcome::Done(Answer::Nothing(vec![1; *reply_bytes as usize]))
        }
        Job::Simulate(_) | Job::Own { .. } | Job::Describe => Outcome::Failed(Failure::Refused {
            reason: "a session without slots computes nothing".to_owned(),
        }),
    }
}

/// One worker that computes nothing: its slots, and what it holds for them.
pub struct Worker {
    /// Place that it fills; its successor fills it too.
    pub place: u64,
    /// Jobs at a time.
    pub slots: usize,
    /// How much longer than others it takes \[1\].
    pub slowness: f64,
    /// What is in its slots.
    pub running: Vec<Running>,
    waiting: VecDeque<Order>,
    /// Results that are not known to be stored.
    pub outbox: BTreeMap<Attempt, Done>,
    settled: BTreeSet<Attempt>,
    /// Whether it stands still.
    pub frozen: bool,
    /// What happened to it while it was frozen.
    pub(super) held_back: Vec<What>,
}

impl Worker {
    /// An idle one.
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
            held_back: Vec::new(),
        }
    }

    /// Takes an order, unless it has it already.
    pub fn take(&mut self, order: Order) {
        let attempt = order.attempt;
        let known = self.settled.contains(&attempt)
            || self.outbox.contains_key(&attempt)
            || self.running.iter().any(|held| held.attempt == attempt)
            || self.waiting.iter().any(|held| held.attempt == attempt);
        if !known {
            self.waiting.push_back(order);
        }
    }

    /// Begins what has waited longest, if there is a slot for it.
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

    /// Stops an attempt; how long it was computed for nothing.
    pub fn cancel(&mut self, attempt: Attempt, now: Duration) -> Duration {
        self.settled.insert(attempt);
        self.outbox.remove(&attempt);
        self.waiting.retain(|order| order.attempt != attempt);
        let running = self.take_running(attempt);
        running.map_or(Duration::ZERO, |running| now.saturating_sub(running.begun))
    }

    /// The result of an attempt that is still wanted.
    pub fn finish(&mut self, attempt: Attempt, now: Duration) -> Option<Done> {
        let running = self.take_running(attempt)?;
        let wall = now.saturating_sub(running.begun);
        let done = Done {
            attempt,
            work: running.job.work_hash(),
            cost: cost(u64::try_from(wall.as_micros()).unwrap_or(u64::MAX)),
            outcome: outcome(&running.job),
        };
        self.outbox.insert(attempt, done.clone());
        Some(done)
    }

    /// Forgets what is stored.
    pub fn settle(&mut self, attempts: Vec<Attempt>) {
        for attempt in attempts {
            self.outbox.remove(&attempt);
            self.settled.insert(attempt);
        }
    }

    /// What it says of itself, with the case that it has and what it computed of the proof.
    pub fn beat(&self, case: Option<ContentHash>, proof: Proof) -> Beat {
        Beat {
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
