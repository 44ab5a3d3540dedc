//! Reduction of the back head to its modes, done by a worker as a job.
use journal::event::JobReason;
use protocol::{
    id::JobId,
    job::{Answer, Job},
    pumping_unit::{REDUCE_HEAD, ReduceHeadSpec, ReducedHead},
    wire::{self, WireError},
};
use study::{self, Evaluator, Stop, StudyError, run_batch};

/// Submits the reduction of a head as a job and returns its result.
///
/// # Errors
/// [`StudyError`] if the job could not be done, or the user stops.
pub(in crate::cli::command) async fn reduce_head(
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
    let reason = JobReason::outside_search("reduction");
    let mut reduced = Vec::new();
    run_batch(
        evaluator,
        vec![(JobId(0), job)],
        &reason,
        stop,
        |_, _, completed| {
            let what = || "the reduction of the back head".to_owned();
            reduced = study::answer(completed, Answer::into_own, what)?;
            Ok(())
        },
    )
    .await?;
    wire::decode(&reduced).map_err(damaged)
}
