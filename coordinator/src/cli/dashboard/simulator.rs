//! Simulation of individuals for the dashboard, by a worker process of its own in a temporary folder.
use crate::cli::run::{bus, temporary::with_temporary_run};
use protocol::{case::Case, id::ContentHash};
use report::Run;
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError, mpsc},
    thread,
    time::Duration,
};
use study::{CompareRequest, PICTURES, StudyError};
use tokio::sync::oneshot;

/// Time after the last request at which the worker process ends.
const IDLE: Duration = Duration::from_mins(1);
/// Maximum number of individuals that one temporary run simulates, below the 256 for which a comparison has
/// job numbers.
const MOST_IN_A_RUN: usize = 200;
/// Maximum number of individuals whose curves are kept; 10 MB for the shipped machine.
const MOST_KEPT: usize = 24;

/// Result of simulating one individual: for each condition its index and the run.
pub(super) type Simulated = Arc<Vec<(usize, Run)>>;

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
            hash: bus::content_hash(case)?,
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
    answer: oneshot::Sender<Result<Simulated, String>>,
}

/// Simulator of individuals, which starts its worker with the first request and keeps the last results.
#[derive(Clone)]
pub(super) struct Simulator {
    requests: mpsc::Sender<Request>,
    kept: Arc<Mutex<BTreeMap<Key, Simulated>>>,
}

impl Simulator {
    /// Creates a simulator without a worker.
    pub(super) fn new() -> Self {
        let (requests, asked) = mpsc::channel();
        let kept = Arc::new(Mutex::new(BTreeMap::new()));
        let own = Arc::clone(&kept);
        thread::spawn(move || answer(&asked, &own));
        Self { requests, kept }
    }

    /// Returns the kept result of an individual.
    pub(super) fn known(&self, case: &HashedCase, genes: &[f64]) -> Option<Simulated> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get(&case.key(genes)).cloned()
    }

    /// Requests the simulation of an individual under all conditions; the answer arrives on the returned
    /// channel.
    pub(super) fn simulate(&self, case: &Arc<HashedCase>, genes: &[f64]) -> Awaited {
        let (answer, receiver) = oneshot::channel();
        if let Some(known) = self.known(case, genes) {
            drop(answer.send(Ok(known)));
            return receiver;
        }
        let request = Request {
            case: Arc::clone(case),
            genes: genes.to_vec(),
            answer,
        };
        // without its thread the request is dropped, which its receiver sees
        drop(self.requests.send(request));
        receiver
    }
}

fn keep(kept: &Mutex<BTreeMap<Key, Simulated>>, key: Key, result: Simulated) {
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.len() >= MOST_KEPT {
        kept.pop_first();
    }
    kept.insert(key, result);
}

/// Answers requests until the simulator is dropped; those for one case in a row share a worker.
fn answer(asked: &mpsc::Receiver<Request>, kept: &Mutex<BTreeMap<Key, Simulated>>) {
    let mut next = None;
    while let Some(first) = next.take().or_else(|| asked.recv().ok()) {
        let case = Arc::clone(&first.case);
        let mut waiting = Some(first);
        let done = with_temporary_run(&case.case, "dashboard", 1, async |bus, stop| {
            for number in 0..MOST_IN_A_RUN {
                let request = match waiting.take() {
                    Some(request) => request,
                    None => match asked.recv_timeout(IDLE) {
                        Ok(request) => request,
                        Err(_) => return Ok(()),
                    },
                };
                if request.case.hash != case.hash {
                    next = Some(request);
                    return Ok(());
                }
                // asked for by several readers
                let own = case.key(&request.genes);
                let known = {
                    let kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                    kept.get(&own).cloned()
                };
                let result = if let Some(known) = known {
                    Ok(known)
                } else {
                    let wanted = wanted(&case.case, number, &request.genes);
                    match study::compare(bus, &case.case, &wanted, stop).await {
                        Ok(compared) => Ok(Arc::new(runs(&compared))),
                        Err(error @ StudyError::Interrupted) => return Err(error),
                        Err(error) => Err(error.to_string()),
                    }
                };
                if let Ok(result) = &result {
                    keep(kept, own, Arc::clone(result));
                }
                drop(request.answer.send(result));
            }
            Ok(())
        });
        if let (Err(error), Some(request)) = (done, waiting) {
            drop(request.answer.send(Err(format!("{error:#}"))));
        }
    }
}

/// Returns the requests that simulate an individual as the run simulates the recommended one.
fn wanted(case: &Case, number: usize, genes: &[f64]) -> Vec<CompareRequest> {
    let wanted = study::recommended(case, PICTURES).into_iter();
    wanted
        .map(|one| CompareRequest {
            first: number,
            individuals: vec![(String::new(), genes.to_vec())],
            ..one
        })
        .collect()
}

fn runs(compared: &[study::Compared]) -> Vec<(usize, Run)> {
    let runs = compared.iter().filter_map(|one| {
        let own = one.individuals.first()?;
        Some((
            one.condition,
            crate::cli::output::calibration::report_run(own),
        ))
    });
    runs.collect()
}
