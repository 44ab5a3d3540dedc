//! One simulated worker: what it holds, and what it makes of what it hears.
use super::{happening::What, *};
use std::collections::VecDeque;

/// An attempt in a slot.
pub(super) struct Running {
    attempt: Attempt,
    work: ContentHash,
    pub(super) begun: Duration,
}

pub(super) struct Worker {
    /// Place that it fills; its successor fills it too.
    pub(super) place: u64,
    pub(super) slots: usize,
    pub(super) slowness: f64,
    pub(super) running: Vec<Running>,
    waiting: VecDeque<Order>,
    pub(super) outbox: BTreeMap<Attempt, Done>,
    settled: BTreeSet<Attempt>,
    pub(super) frozen: bool,
    /// What happened to it while it was frozen.
    pub(super) held_back: Vec<What>,
}

impl Worker {
    pub(super) const fn new(place: u64, slots: usize, slowness: f64) -> Self {
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
    pub(super) fn take(&mut self, order: Order) {
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
    pub(super) fn begin(&mut self, now: Duration) -> Option<Attempt> {
        (self.running.len() < self.slots).then_some(())?;
        let order = self.waiting.pop_front()?;
        self.running.push(Running {
            attempt: order.attempt,
            work: order.job.work_hash(),
            begun: now,
        });
        Some(order.attempt)
    }

    /// Stops an attempt; how long it was computed for nothing.
    pub(super) fn cancel(&mut self, attempt: Attempt, now: Duration) -> Duration {
        self.settled.insert(attempt);
        self.outbox.remove(&attempt);
        self.waiting.retain(|order| order.attempt != attempt);
        let running = self.take_running(attempt);
        running.map_or(Duration::ZERO, |running| now.saturating_sub(running.begun))
    }

    /// The result of an attempt that is still wanted.
    pub(super) fn finish(&mut self, attempt: Attempt, now: Duration) -> Option<Done> {
        let running = self.take_running(attempt)?;
        let wall = now.saturating_sub(running.begun);
        let done = Done {
            attempt,
            work: running.work,
            cost: cost(u64::try_from(wall.as_micros()).expect("short")),
            outcome: Outcome::Done(Answer::Nothing(vec![1])),
        };
        self.outbox.insert(attempt, done.clone());
        Some(done)
    }

    /// Forgets what is stored.
    pub(super) fn settle(&mut self, attempts: Vec<Attempt>) {
        for attempt in attempts {
            self.outbox.remove(&attempt);
            self.settled.insert(attempt);
        }
    }

    /// What it says of itself.
    pub(super) fn beat(&self) -> Beat {
        Beat {
            number: 0,
            case: Some(CASE),
            proof: Some(PROOF),
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
