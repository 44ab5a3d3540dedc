//! Evaluation of individuals requested by another program: scored as requests arrive, and returned in order
//! of completion.
//!
//! Independent of the source and the format of the requests. A job is numbered by its content
//! ([`super::job_number`]), so that a resumed run finds repeated requests in its journal, in any order.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    stop::{Stop, or_stop},
};
use journal::event::JobReason;
use protocol::{
    case::Case,
    id::JobId,
    job::{Answer, Evaluation, Failure, Individual, Job, Outcome, Reply, SimulateSpec},
};
use std::collections::BTreeMap;
use tokio::sync::mpsc;

/// Purpose of jobs that another program, or a table, requested.
pub(super) const EVALUATION: &str = "evaluation";

/// Request to score an individual.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluationRequest<T> {
    /// Identification of the request, chosen by the requesting program and returned with the answer.
    pub tag: T,
    /// Values of the unknowns in the order of the case [declared units].
    pub genes: Vec<f64>,
    /// Whether the answer contains the residual vector.
    pub with_residual: bool,
}

/// Result of scoring an individual: an evaluation, or a failure that concerns this individual alone.
pub type Scored = Result<Evaluation, Failure>;

/// Scores requested individuals until the channel of requests is closed; `answer` is called for every
/// request, and equal requests share one job.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if no evaluator is left, if the user stops
/// it, or if `answer` fails.
pub async fn evaluate<E: Evaluator, T>(
    evaluator: &mut E,
    case: &Case,
    requests: &mut mpsc::Receiver<EvaluationRequest<T>>,
    answer: &mut dyn FnMut(T, &Scored) -> anyhow::Result<()>,
    stop: &mut Stop,
) -> anyhow::Result<()> {
    let mut open: BTreeMap<JobId, Vec<T>> = BTreeMap::new();
    let mut known: BTreeMap<JobId, Scored> = BTreeMap::new();
    let mut numbers = evaluator.numbers()?;
    let mut asking = true;
    while asking || !open.is_empty() {
        let event = async {
            tokio::select! {
                biased;
                request = requests.recv(), if asking => Event::Request(request),
                completed = evaluator.next(), if !open.is_empty() => Event::Completed(completed),
            }
        };
        match or_stop(event, stop).await? {
            Event::Request(None) => asking = false,
            Event::Request(Some(request)) => {
                let job = job(case, &request);
                let id = numbers.number(&job);
                if let Some(scored) = known.get(&id) {
                    answer(request.tag, scored)?;
                } else if let Some(tags) = open.get_mut(&id) {
                    tags.push(request.tag);
                } else {
                    evaluator.submit(id, job, JobReason::outside_search(EVALUATION))?;
                    open.insert(id, vec![request.tag]);
                }
            }
            Event::Completed(completed) => {
                let completed = completed?;
                let Some(tags) = open.remove(&completed.id) else {
                    continue;
                };
                let scored = scored(completed.id, completed.outcome)?;
                for tag in tags {
                    answer(tag, &scored)?;
                }
                known.insert(completed.id, scored);
            }
        }
    }
    Ok(())
}

enum Event<T, C> {
    Request(Option<EvaluationRequest<T>>),
    Completed(C),
}

pub(super) fn job<T>(case: &Case, request: &EvaluationRequest<T>) -> Job {
    let individual = Individual::new(case.objective.condition, request.genes.clone());
    let with_residual = request.with_residual;
    Job::Simulate(SimulateSpec::new(
        individual,
        Reply::Score {
            with_residual,
            whole: true,
        },
    ))
}

pub(super) fn scored(id: JobId, outcome: Outcome) -> Result<Scored, StudyError> {
    match outcome {
        Outcome::Done(answer) => match Answer::into_scored(answer) {
            Ok(evaluation) => Ok(Ok(evaluation)),
            Err(_) => Err(StudyError::WrongKind { id }),
        },
        Outcome::Failed(failure) => match StudyError::from_systematic_failure(&failure) {
            Some(error) => Err(error),
            None => Ok(Err(failure)),
        },
    }
}
