//! The slots of a worker: each has a keeper thread here and a process that computes.
//!
//! The keeper lives as long as the worker, because a parent-death signal follows the *thread*
//! that started a process. It ends its process (and whatever that started) at the deadline.
mod child;
mod keeper;

use keeper::{Keeper, ToKeeper};
use protocol::{
    job::{Job, Outcome},
    message::Attempt,
};
use std::{
    io,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::UnboundedSender;

/// A keeper that does not show itself for so long is stuck, and so is the worker.
const STUCK: Duration = Duration::from_secs(3);

/// The encoded case, as slots are given it.
#[derive(Clone, Debug)]
pub struct CaseBytes {
    /// Its name.
    pub hash: protocol::id::ContentHash,
    /// Its content.
    pub bytes: Arc<[u8]>,
}

/// How the processes of slots are started.
#[derive(Clone, Debug)]
pub struct SlotOptions {
    /// Program whose `slot` subcommand computes.
    pub program: PathBuf,
    /// Address space that a process may have (MiB); 0 for as much as there is.
    pub memory_mib: u64,
}

/// A job for a slot.
#[derive(Clone, Debug)]
pub struct Task {
    /// Which try at which job.
    pub attempt: Attempt,
    /// From start to forced end.
    pub deadline: Duration,
    /// What to do.
    pub job: Box<Job>,
    /// On what.
    pub case: Option<CaseBytes>,
}

/// A slot is free again.
#[derive(Clone, Debug, PartialEq)]
pub struct Freed {
    /// Which slot.
    pub slot: usize,
    /// What it did.
    pub attempt: Attempt,
    /// How long.
    pub wall: Duration,
    /// What came out; none if it was cancelled.
    pub outcome: Option<Outcome>,
}

/// All slots of a worker; dropping it ends their processes.
#[derive(Debug)]
pub struct Pool {
    keepers: Vec<mpsc::Sender<ToKeeper>>,
    threads: Vec<thread::JoinHandle<()>>,
    pulses: Arc<[AtomicU64]>,
    begun: Instant,
}

impl Pool {
    /// Starts the keepers; processes start with the first job.
    ///
    /// # Errors
    /// If a thread cannot be started.
    pub fn start(
        slots: usize,
        options: &SlotOptions,
        freed: &UnboundedSender<Freed>,
    ) -> io::Result<Self> {
        let pulses: Arc<[AtomicU64]> = (0..slots).map(|_| AtomicU64::new(0)).collect();
        let begun = Instant::now();
        let mut keepers = Vec::new();
        let mut threads = Vec::new();
        for slot in 0..slots {
            let (to, messages) = mpsc::channel();
            let (pulses, freed) = (Arc::clone(&pulses), freed.clone());
            let mut keeper = Keeper::new(slot, options.clone(), to.clone(), freed);
            let keep = move || {
                let pulse = || {
                    if let Some(pulse) = pulses.get(slot) {
                        pulse.store(millis(begun.elapsed()), Ordering::Relaxed);
                    }
                };
                keeper.keep(&messages, pulse);
            };
            threads.push(
                thread::Builder::new()
                    .name(format!("slot-{slot}"))
                    .spawn(keep)?,
            );
            keepers.push(to);
        }
        Ok(Self {
            keepers,
            threads,
            pulses,
            begun,
        })
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.keepers.len()
    }

    /// Whether there is no slot.
    pub fn is_empty(&self) -> bool {
        self.keepers.is_empty()
    }

    /// Gives a free slot a job.
    pub fn run(&self, slot: usize, task: Task) {
        self.tell(slot, ToKeeper::Run(task));
    }

    /// Ends what a slot does, if it is still this attempt.
    pub fn cancel(&self, slot: usize, attempt: Attempt) {
        self.tell(slot, ToKeeper::Cancel(attempt));
    }

    /// Whether all keepers do their work; without it a worker must not claim to be alive.
    pub fn is_alive(&self) -> bool {
        let now = millis(self.begun.elapsed());
        let alive =
            |pulse: &AtomicU64| now.saturating_sub(pulse.load(Ordering::Relaxed)) < millis(STUCK);
        self.pulses.iter().all(alive) && self.threads.iter().all(|thread| !thread.is_finished())
    }

    fn tell(&self, slot: usize, message: ToKeeper) {
        let sent = self
            .keepers
            .get(slot)
            .is_some_and(|keeper| keeper.send(message).is_ok());
        if !sent {
            tracing::error!(slot, "the keeper of a slot has ended");
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        for slot in 0..self.keepers.len() {
            self.tell(slot, ToKeeper::End);
        }
        for thread in self.threads.drain(..) {
            if thread.join().is_err() {
                tracing::error!("the keeper of a slot panicked");
            }
        }
    }
}

fn millis(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
