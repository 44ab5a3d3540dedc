//! Slots of a worker: each has a keeper thread in this process and a child process that computes.
//!
//! The keeper thread lives as long as the worker, because a parent-death signal follows the *thread* that
//! started a process. It ends its process, and every process started by that one, at the deadline.
mod child;
mod keeper;
mod task;

pub use task::{CaseBytes, Freed, SlotOptions, Task};

use keeper::{Keeper, ToKeeper};
use protocol::message::Attempt;
use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::UnboundedSender;

/// Time without a sign of life (pulse) after which a keeper thread, and hence the worker, counts as stuck.
const STUCK: Duration = Duration::from_secs(3);

/// All slots of a worker, each of which computes one job at a time; their processes are ended on drop.
#[derive(Debug)]
pub struct Pool {
    keepers: Vec<mpsc::Sender<ToKeeper>>,
    threads: Vec<thread::JoinHandle<()>>,
    pulses: Arc<[AtomicU64]>,
    begun: Instant,
}

impl Pool {
    /// Starts the keeper threads of all slots; a slot's process is started with its first job.
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

    /// Returns the number of slots.
    pub fn len(&self) -> usize {
        self.keepers.len()
    }

    /// Returns whether the pool has no slots.
    pub fn is_empty(&self) -> bool {
        self.keepers.is_empty()
    }

    /// Starts a job in a free slot.
    pub fn run(&self, slot: usize, task: Task) {
        self.send(slot, ToKeeper::Run(task));
    }

    /// Cancels the job of a slot, if the slot still computes the given attempt.
    pub fn cancel(&self, slot: usize, attempt: Attempt) {
        self.send(slot, ToKeeper::Cancel(attempt));
    }

    /// Returns whether all keeper threads are responsive; if not, the worker must not send heartbeats.
    pub fn is_alive(&self) -> bool {
        let now = millis(self.begun.elapsed());
        let alive =
            |pulse: &AtomicU64| now.saturating_sub(pulse.load(Ordering::Relaxed)) < millis(STUCK);
        self.pulses.iter().all(alive) && self.threads.iter().all(|thread| !thread.is_finished())
    }

    fn send(&self, slot: usize, message: ToKeeper) {
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
            self.send(slot, ToKeeper::End);
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
