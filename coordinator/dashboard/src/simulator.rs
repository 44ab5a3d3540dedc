//! Simulation of individuals for the dashboard, by a worker process of its own in a temporary folder.
use protocol::{case::Case, id::ContentHash};
use report::ScoredCurves;
use run::{hash, session::temporary::with_temporary_run};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc},
    thread,
    time::{Duration, Instant},
};
use study::{CompareRequest, NamedIndividual, PICTURES, StudyError};
use tokio::sync::oneshot;

/// Longest wait for the end of the worker when the dashboard ends.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time after the last request at which the worker process ends.
const IDLE: Duration = Duration::from_mins(1);
/// Maximum number of individuals that one temporary run simulates, below the 256 for which a comparison has
/// job numbers.
const MOST_IN_A_RUN: usize = 200;
/// Maximum number of individuals whose curves are kept; 10 MB for the shipped machine.
const MOST_KEPT: usize = 24;

/// Maximum number of individuals that wait to be simulated.
const MOST_WAITING: usize = 16;
/// Maximum number of readers that wait for the same individual.
const MOST_READERS: usize = 64;

/// Result of simulating one individual: for each condition its index and the run.
pub(super) type Simulated = Arc<Vec<(usize, ScoredCurves)>>;

/// Answer to a request that arrives later: the result, or why the individual could not be simulated.
pub(super) type Awaited = oneshot::Receiver<Result<Simulated, String>>;

/// Case with the hash of its content, by which results of several runs are kept apart.
pub(super) struct HashedCase {
    pub(super) case: Case,
    hash: ContentHash,
}

impl HashedCase {
    /// Computes the hash of a case.
    ///
    /// # Errors
    /// If the case cannot be encoded.
    pub(super) fn new(case: &Case) -> anyhow::Result<Arc<Self>> {
        Ok(Arc::new(Self {
            case: case.clone(),
            hash: hash::content_hash(case)?,
        }))
    }

    /// Returns the key of an individual's results: the case and the bits of the individual's values.
    fn key(&self, genes: &[f64]) -> Key {
        (self.hash, genes.iter().map(|gene| gene.to_bits()).collect())
    }
}

/// Key of an individual's results.
type Key = (ContentHash, Vec<u64>);

struct Request {
    case: Arc<HashedCase>,
    genes: Vec<f64>,
}

/// Message to the simulator's thread.
enum Message {
    Simulate(Request),
    /// Ends the worker and removes its temporary run.
    End,
}

/// Readers that wait for the result of an individual.
type Readers = Vec<oneshot::Sender<Result<Simulated, String>>>;

/// Results and requests that the simulator and its thread share.
#[derive(Default)]
struct Shared {
    kept: BTreeMap<Key, Simulated>,
    /// Readers of the individuals that wait or are being simulated.
    awaited: BTreeMap<Key, Readers>,
}

/// Simulator of individuals, which starts its worker with the first request and keeps the last results.
#[derive(Clone)]
pub(super) struct Simulator {
    requests: mpsc::SyncSender<Message>,
    shared: Arc<Mutex<Shared>>,
    /// Receiver whose sender the thread drops at its end.
    ended: Arc<Mutex<mpsc::Receiver<()>>>,
}

impl Simulator {
    /// Creates a simulator without a worker.
    pub(super) fn new() -> Self {
        let (simulator, asked, running) = Self::without_thread();
        let shared = Arc::clone(&simulator.shared);
        thread::spawn(move || {
            answer(&asked, &shared);
            drop(running);
        });
        simulator
    }

    /// Ends the worker and removes its temporary run; waits for that, but not longer than [`PATIENCE`].
    pub(super) fn close(&self) {
        // a full queue is worked off, or its requests are dropped with their readers
        let begun = Instant::now();
        while let Err(mpsc::TrySendError::Full(_)) = self.requests.try_send(Message::End) {
            if begun.elapsed() > PATIENCE {
                return;
            }
            thread::sleep(Duration::from_millis(50));
        }
        let ended = self.ended.lock().unwrap_or_else(PoisonError::into_inner);
        let _or_late = ended.recv_timeout(PATIENCE);
    }

    /// Creates a simulator with the messages that its thread is to answer, and the sender to drop at the thread's end.
    fn without_thread() -> (Self, mpsc::Receiver<Message>, mpsc::Sender<()>) {
        let (requests, asked) = mpsc::sync_channel(MOST_WAITING);
        let (running, ended) = mpsc::channel();
        let simulator = Self {
            requests,
            shared: Arc::default(),
            ended: Arc::new(Mutex::new(ended)),
        };
        (simulator, asked, running)
    }

    /// Returns the kept result of an individual.
    pub(super) fn known(&self, case: &HashedCase, genes: &[f64]) -> Option<Simulated> {
        lock(&self.shared).kept.get(&case.key(genes)).cloned()
    }

    /// Requests the simulation of an individual under all conditions; the answer arrives on the returned
    /// channel. Requests for the same individual are answered by one simulation, and one that nobody waits for any
    /// longer is dropped.
    pub(super) fn simulate(&self, case: &Arc<HashedCase>, genes: &[f64]) -> Awaited {
        let (answer, receiver) = oneshot::channel();
        let key = case.key(genes);
        let mut shared = lock(&self.shared);
        if let Some(known) = shared.kept.get(&key) {
            drop(answer.send(Ok(Arc::clone(known))));
            return receiver;
        }
        let is_new = !shared.awaited.contains_key(&key);
        let request = || {
            Message::Simulate(Request {
                case: Arc::clone(case),
                genes: genes.to_vec(),
            })
        };
        if is_new && self.requests.try_send(request()).is_err() {
            let message = "too many individuals are waiting to be simulated; choose it again later";
            drop(answer.send(Err(message.to_owned())));
            return receiver;
        }
        let readers = shared.awaited.entry(key).or_default();
        readers.retain(|reader| !reader.is_closed());
        if readers.len() < MOST_READERS {
            readers.push(answer);
        }
        receiver
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    fn keep(&mut self, key: Key, result: Simulated) {
        if self.kept.len() >= MOST_KEPT {
            self.kept.pop_first();
        }
        self.kept.insert(key, result);
    }

    /// Returns whether a reader still waits for an individual; forgets the request otherwise.
    fn is_awaited(&mut self, key: &Key) -> bool {
        let readers = self.awaited.get(key);
        let is_awaited = readers.is_some_and(|all| all.iter().any(|reader| !reader.is_closed()));
        if !is_awaited {
            self.awaited.remove(key);
        }
        is_awaited
    }

    /// Answers all readers of an individual.
    fn answer(&mut self, key: &Key, result: &Result<Simulated, String>) {
        for reader in self.awaited.remove(key).into_iter().flatten() {
            // who has left hears nothing
            drop(reader.send(result.clone()));
        }
    }
}

/// Answers requests until the simulator is closed or dropped; those for one case in a row share a worker.
fn answer(asked: &mpsc::Receiver<Message>, shared: &Mutex<Shared>) {
    let (mut next, mut is_open) = (None, true);
    while is_open {
        let first = match next.take().map_or_else(|| asked.recv(), Ok) {
            Ok(Message::Simulate(first)) => first,
            Ok(Message::End) | Err(_) => return,
        };
        let (case, key) = (Arc::clone(&first.case), first.case.key(&first.genes));
        if !lock(shared).is_awaited(&key) {
            continue;
        }
        let mut waiting = Some(first);
        let done = with_temporary_run(&case.case, "dashboard", 1, async |dispatch, stop| {
            let mut number = 0;
            while number < MOST_IN_A_RUN {
                let request = match waiting.take() {
                    Some(request) => request,
                    None => match asked.recv_timeout(IDLE) {
                        Ok(Message::Simulate(request)) => request,
                        Ok(Message::End) => {
                            is_open = false;
                            return Ok(());
                        }
                        Err(_) => return Ok(()),
                    },
                };
                if request.case.hash != case.hash {
                    next = Some(Message::Simulate(request));
                    return Ok(());
                }
                let key = case.key(&request.genes);
                if !lock(shared).is_awaited(&key) {
                    continue;
                }
                let wanted = wanted(&case.case, number, &request.genes);
                number += 1;
                let result = match study::compare(dispatch, &case.case, &wanted, stop).await {
                    Ok(compared) => Ok(Arc::new(runs(&compared))),
                    Err(error @ StudyError::Interrupted) => return Err(error),
                    Err(error) => Err(error.to_string()),
                };
                let mut shared = lock(shared);
                if let Ok(result) = &result {
                    shared.keep(key.clone(), Arc::clone(result));
                }
                shared.answer(&key, &result);
            }
            Ok(())
        });
        if let Err(error) = done {
            lock(shared).answer(&key, &Err(format!("{error:#}")));
        }
    }
}

/// Returns the requests that simulate an individual as the run simulates the recommended one.
fn wanted(case: &Case, number: usize, genes: &[f64]) -> Vec<CompareRequest> {
    let wanted = study::recommended(case, PICTURES).into_iter();
    wanted
        .map(|one| CompareRequest {
            first: number,
            individuals: vec![NamedIndividual::new("", genes.to_vec())],
            ..one
        })
        .collect()
}

fn runs(compared: &[study::Compared]) -> Vec<(usize, ScoredCurves)> {
    let runs = compared.iter().filter_map(|one| {
        let own = one.individuals.first()?;
        Some((one.condition, run::calibration::scored_curves(own)))
    });
    runs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that requests for the same individual are merged, that the number of those that wait is limited, and that
    /// one whose readers have left is dropped. Regression: every request was queued and simulated.
    #[test]
    fn requests_are_merged_limited_and_dropped_with_their_readers() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/cyjs10-5-37hb");
        let loaded = case::load(std::path::Path::new(folder), &case::Overrides::default()).unwrap();
        let case = HashedCase::new(&loaded).unwrap();
        let (simulator, asked, _running) = Simulator::without_thread();
        let mut first = simulator.simulate(&case, &[0.0]);
        let same = simulator.simulate(&case, &[0.0]);
        let more = MOST_WAITING - 1;
        let others: Vec<Awaited> = (1..=more)
            .map(|number| simulator.simulate(&case, &[number as f64]))
            .collect();
        let refused = simulator.simulate(&case, &[-1.0]).blocking_recv().unwrap();
        assert!(refused.unwrap_err().contains("too many"));
        assert_eq!(asked.try_iter().count(), MOST_WAITING, "two are one");
        let is_awaited = |gene: f64| lock(&simulator.shared).is_awaited(&case.key(&[gene]));
        drop(same);
        assert!(is_awaited(0.0) && is_awaited(1.0));
        drop(others);
        assert!(!is_awaited(1.0) && is_awaited(0.0));
        let key = case.key(&[0.0]);
        lock(&simulator.shared).answer(&key, &Err("it fails".to_owned()));
        assert_eq!(first.try_recv().unwrap().unwrap_err(), "it fails");
    }
}
