//! Reduction of the back head to its modes, done by a worker as a job.
use protocol::{
    id::JobId,
    job::{Answer, Job},
    pumping_unit::{REDUCE_HEAD, ReduceHeadSpec, ReducedHead},
    wire::{self, WireError},
};
use study::{self, Evaluator, Stop, StudyError, or_stop};

/// Submits the reduction of a head as a job and returns its result.
///
/// # Errors
/// [`StudyError`] if the job could not be done, or the user stops.
pub async fn reduce_head(
    evaluator: &mut impl Evaluator,
    spec: &ReduceHeadSpec,
    stop: &mut Stop,
) -> Result<ReducedHead, StudyError> {
    let damaged = |error: WireError| StudyError::Misconfigured {
        field: REDUCE_HEAD.to_owned(),
        problem: error.to_string(),
    };
    let job = Job::Own {
        name: REDUCE_HEAD.to_owned(),
        body: wire::encode(spec).map_err(damaged)?,
    };
    evaluator.submit(JobId(0), job)?;
    let completed = or_stop(evaluator.next(), stop).await??;
    let what = || "the reduction of the back head".to_owned();
    let answer = study::answer(completed, Answer::into_own, what)?;
    wire::decode(&answer).map_err(damaged)
}
