//! Link within one process with simulated faults: seeded loss, duplication and delay.
//!
//! Reordering needs no rule of its own, because each copy of a frame has its own delay.
use crate::{Blob, CoordinatorEnd, LinkError, LinkEvent, WorkerEnd};
use protocol::{
    id::{ContentHash, RunId, WorkerId, draw},
    key::Lane,
};
use std::{
    collections::BTreeMap,
    future::Future,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// Simulated faults of an in-process link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultInjection {
    /// Seed of the pseudo-random draws that decide the fate of each frame.
    pub seed: u64,
    /// Share of frames that are lost \[1\].
    pub loss: f64,
    /// Share of frames that arrive twice \[1\].
    pub duplication: f64,
    /// Maximum delay of a frame; delays are uniform between 0 and this value.
    pub delay: Duration,
}

impl FaultInjection {
    /// Fault settings of a link that loses, duplicates and delays nothing.
    pub const NONE: Self = Self {
        seed: 0,
        loss: 0.0,
        duplication: 0.0,
        delay: Duration::ZERO,
    };
}

/// State shared by the coordinator's and the workers' ends of an in-process link.
#[derive(Debug)]
struct Shared {
    faults: FaultInjection,
    drawn: AtomicU64,
    blob: Blob,
    to_coordinator: UnboundedSender<LinkEvent>,
    workers: Mutex<BTreeMap<WorkerId, UnboundedSender<Vec<u8>>>>,
}

impl Shared {
    /// Draws a pseudo-random number, uniform in [0, 1).
    fn draw(&self) -> f64 {
        let count = self.drawn.fetch_add(1, Ordering::Relaxed);
        let place = u128::from(self.faults.seed) << 64 | u128::from(count);
        (draw("faults", place) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Delivers a frame zero, one or two times, each time with a delay, according to the fault model.
    fn pass(&self, deliver: impl Fn() + Send + Clone + 'static) {
        let copies = if self.draw() < self.faults.loss {
            0
        } else if self.draw() < self.faults.duplication {
            2
        } else {
            1
        };
        for _ in 0..copies {
            let delay = self.faults.delay.mul_f64(self.draw());
            if delay.is_zero() {
                deliver();
            } else {
                let deliver = deliver.clone();
                tokio::spawn(async move {
                    tokio::time::sleep(delay).await;
                    deliver();
                });
            }
        }
    }
}

/// Connection point through which workers join an in-process link.
#[derive(Clone, Debug)]
pub struct Hub(Arc<Shared>);

impl Hub {
    /// Creates the coordinator's end of an in-process link and the hub through which workers join it.
    pub fn new(faults: FaultInjection, blob: Blob) -> (MemoryCoordinator, Self) {
        let (to_coordinator, heard) = unbounded_channel();
        let shared = Arc::new(Shared {
            faults,
            drawn: AtomicU64::new(0),
            blob,
            to_coordinator,
            workers: Mutex::default(),
        });
        let coordinator = MemoryCoordinator {
            shared: Arc::clone(&shared),
            heard,
        };
        (coordinator, Self(shared))
    }

    /// Creates the end of a worker with the given id.
    pub fn worker(&self, id: WorkerId) -> MemoryWorker {
        let (sender, frames) = unbounded_channel();
        self.0
            .workers
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(id, sender);
        MemoryWorker {
            id,
            shared: Arc::clone(&self.0),
            frames,
        }
    }
}

/// Coordinator's end of an in-process link.
#[derive(Debug)]
pub struct MemoryCoordinator {
    shared: Arc<Shared>,
    heard: UnboundedReceiver<LinkEvent>,
}

impl CoordinatorEnd for MemoryCoordinator {
    fn send(&mut self, to: WorkerId, _lane: Lane, frame: Vec<u8>) {
        let worker = {
            let workers = self
                .shared
                .workers
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            workers.get(&to).cloned()
        };
        if let Some(worker) = worker {
            self.shared.pass(move || {
                // a worker that is gone hears nothing
                drop(worker.send(frame.clone()));
            });
        }
    }

    async fn receive(&mut self) -> Option<LinkEvent> {
        self.heard.recv().await
    }

    async fn close(self) {
        self.shared
            .workers
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clear();
    }
}

/// Worker's end of an in-process link; when it is dropped, the coordinator is told that the worker is lost.
#[derive(Debug)]
pub struct MemoryWorker {
    id: WorkerId,
    shared: Arc<Shared>,
    frames: UnboundedReceiver<Vec<u8>>,
}

impl WorkerEnd for MemoryWorker {
    fn send(&mut self, _run: RunId, _lane: Lane, frame: Vec<u8>) {
        let (to, id) = (self.shared.to_coordinator.clone(), self.id);
        self.shared.pass(move || {
            // a coordinator that is gone hears nothing
            drop(to.send(LinkEvent::Frame(id, frame.clone())));
        });
    }

    async fn receive(&mut self) -> Option<Vec<u8>> {
        self.frames.recv().await
    }

    async fn announce_presence(&mut self, _run: RunId) -> Result<(), LinkError> {
        Ok(())
    }

    fn fetch(
        &self,
        _run: RunId,
        hash: ContentHash,
        chunk: u32,
    ) -> impl Future<Output = Result<Vec<u8>, LinkError>> + Send + 'static {
        let missing = |reason: &str| LinkError::Piece {
            hash,
            chunk,
            reason: reason.to_owned(),
        };
        let lost = self.shared.draw() < self.shared.faults.loss;
        let piece = if lost {
            Err(missing("lost on the way"))
        } else {
            let piece = self.shared.blob.chunk(hash, chunk);
            piece
                .map(<[u8]>::to_vec)
                .ok_or_else(|| missing("not known here"))
        };
        std::future::ready(piece)
    }

    async fn close(self) {}
}

impl Drop for MemoryWorker {
    fn drop(&mut self) {
        self.shared
            .workers
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .remove(&self.id);
        // a coordinator that is gone hears nothing
        drop(
            self.shared
                .to_coordinator
                .send(LinkEvent::Disconnected(self.id)),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    async fn count(faults: FaultInjection) -> usize {
        let (mut coordinator, hub) = Hub::new(faults, Blob::new(vec![1]));
        let mut worker = hub.worker(WorkerId(1));
        for n in 0..1000_u16 {
            worker.send(RunId(0), Lane::Data, n.to_le_bytes().to_vec());
        }
        tokio::time::sleep(faults.delay * 2).await;
        drop(worker);
        let mut frames = 0;
        while coordinator.receive().await != Some(LinkEvent::Disconnected(WorkerId(1))) {
            frames += 1;
        }
        frames
    }

    #[tokio::test]
    async fn faults_are_what_was_asked_for_and_repeat_with_the_seed() {
        assert_eq!(count(FaultInjection::NONE).await, 1000);
        let faults = FaultInjection {
            seed: 4,
            loss: 0.2,
            duplication: 0.2,
            delay: Duration::ZERO,
        };
        let frames = count(faults).await;
        assert_eq!(count(faults).await, frames);
        assert!((900..1020).contains(&frames), "{frames} of 960 expected");
        assert!(
            (700..900).contains(
                &count(FaultInjection {
                    duplication: 0.0,
                    ..faults
                })
                .await
            )
        );
    }
}
