//! Faults of a simulated cluster: what each does to coordinator, disk and workers, and how the coordinator starts again.
use super::{Cluster, Fault, PROOF, Process, event::ClusterEvent, options};
use crate::{
    runtime::Coordination,
    scheduler::{Core, CoreOptions, Input},
};
use protocol::{
    id::{ContentHash, WorkerId},
    proof::ReferenceResult,
};
use std::{mem, sync::Arc, time::Duration};

/// Time after which the transport notices that a worker cannot be reached.
const UNREACHABLE: Duration = Duration::from_secs(3);
/// Time after which a coordinator that was killed is started again.
const DOWN: Duration = Duration::from_secs(4);
/// Time between two attempts to write to a full disk.
const RETRY: Duration = Duration::from_secs(1);

#[expect(
    clippy::multiple_inherent_impl,
    reason = "a cluster without faults needs none of it"
)]
impl Cluster {
    /// Writes the journal; on a full disk it is tried again.
    pub(super) fn flush(&mut self) {
        let is_up = self.is_up();
        let Some(journal) = self.journal.as_mut().filter(|_| is_up) else {
            return;
        };
        if let Some(jobs) = journal.flush() {
            if mem::take(&mut self.is_paused) {
                self.tell_core(Input::Writable(true));
            }
            if !jobs.is_empty() {
                self.tell_core(Input::Stored { jobs });
            }
            return;
        }
        if !mem::replace(&mut self.is_paused, true) {
            self.tell_core(Input::Writable(false));
        }
        self.schedule(RETRY, ClusterEvent::Flush);
    }

    /// Returns whether there is a coordinator process.
    pub(super) fn is_up(&self) -> bool {
        self.process != Process::Ended
    }

    /// Kills the coordinator as [`Fault::Crash`] does.
    pub(super) fn crash(&mut self, number: usize) {
        let is_up = self.is_up();
        let Some(journal) = self.journal.as_mut().filter(|_| is_up) else {
            return;
        };
        journal.crash(number);
        self.process = Process::Ended;
        self.stopped = None;
        self.undelivered_outcomes.clear();
        self.events
            .retain(|_, what| !matches!(what, ClusterEvent::Flush | ClusterEvent::Start));
        self.schedule(DOWN, ClusterEvent::Start);
    }

    /// Starts a coordinator process, which reads the journal.
    pub(super) fn open(&mut self) {
        let Some(journal) = self.journal.as_mut() else {
            return;
        };
        let opened = journal.open();
        // a proof that was not written before a crash is that of the next worker
        let is_proved = opened.run.proof.is_some();
        let core = Core::new(CoreOptions {
            epoch: opened.epoch,
            model_digest: opened.run.model_digest,
            proof: opened.run.proof,
            finished: opened.results.keys().copied().collect(),
            expected: opened.run.present.into_keys().collect(),
            ..options(self.policy.clone())
        });
        self.coordination = Coordination::new(core, Arc::clone(&self.divide));
        self.recorded = opened.results;
        self.is_proved = is_proved;
        if !is_proved {
            // the first result decides which workers are sound
            for worker in self.workers.values_mut() {
                worker.proof = PROOF;
            }
        }
        self.processes += 1;
        (self.process, self.is_paused) = (Process::Started, false);
        self.anticipated.clear();
        self.charged.clear();
    }

    pub(super) fn apply_fault(&mut self, place: u64, fault: Fault) {
        let mut workers = self.workers.iter();
        let found = workers.find(|(_, worker)| worker.place == place);
        let id = found.map(|(id, _)| *id);
        match (fault, id) {
            (Fault::FillDisk | Fault::FreeDisk, _) => {
                if let Some(journal) = &mut self.journal {
                    journal.is_full = fault == Fault::FillDisk;
                }
            }
            (Fault::Crash(number), _) => self.crash(number),
            (Fault::Return, Some(id)) => {
                let is_sound = self.workers.get(&id).is_some_and(|worker| {
                    worker.proof == PROOF && !worker.refuses && !worker.frozen && !worker.drained
                });
                if !is_sound || self.cut_off.contains(&id) {
                    self.kill(id);
                    self.start(place);
                }
            }
            (Fault::Return, None) => drop(self.start(place)),
            // a place that is empty has no faults
            (_, None) => {}
            (Fault::Kill, Some(id)) => {
                self.kill(id);
                self.start(place);
            }
            (Fault::Vanish, Some(id)) => self.kill(id),
            (Fault::Differ, Some(id)) => {
                self.kill(id);
                let new = self.start(place);
                // the first result of a run is that of a sound worker
                if let Some(worker) = self.workers.get_mut(&new).filter(|_| self.is_proved) {
                    worker.proof = ReferenceResult::Bits(ContentHash([9; 32]));
                }
            }
            (Fault::Partition, Some(id)) => {
                self.cut_off.insert(id);
                self.schedule(UNREACHABLE, ClusterEvent::Unreachable(id));
            }
            (Fault::Heal, Some(id)) => drop(self.cut_off.remove(&id)),
            (Fault::Drain(how), Some(worker)) => {
                if let Some(worker) = self.workers.get_mut(&worker) {
                    worker.drained = true;
                }
                self.tell_core(Input::Drain { worker, how });
            }
            (Fault::Freeze | Fault::Thaw | Fault::Refuse, Some(id)) => {
                let Some(worker) = self.workers.get_mut(&id) else {
                    return;
                };
                worker.refuses |= fault == Fault::Refuse;
                worker.frozen |= fault == Fault::Freeze;
                if fault == Fault::Thaw {
                    worker.frozen = false;
                    for what in mem::take(&mut worker.deferred_events) {
                        self.schedule(Duration::ZERO, what);
                    }
                }
            }
        }
    }

    /// Terminates a worker; what it said last dies with it, and the transport reports the loss.
    pub(super) fn kill(&mut self, id: WorkerId) {
        let Some(dead) = self.workers.remove(&id) else {
            return;
        };
        self.events
            .retain(|_, what| !matches!(what, ClusterEvent::Up(from, _) | ClusterEvent::Heard(from, _) if *from == id));
        for running in &dead.running {
            self.computed += self.now.saturating_sub(running.begun);
        }
        self.cut_off.remove(&id);
        self.tell_core(Input::Disconnected { worker: id });
    }
}
