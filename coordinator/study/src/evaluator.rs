//! Interface between a study and the evaluator of its jobs: submission, results, entries, and the state of workers.
use super::entry::Entry;
use super::error::{EvaluatorError, StudyError};
use super::job_number::JobNumbers;
use dispatch::scheduler::{Completed, Snapshot};
use journal::event::JobReason;
use protocol::{
    id::JobId,
    job::{Answer, Job, UnexpectedAnswer},
};

/// Interface to the computing of a study's jobs, which are completed in any order.
pub trait Evaluator {
    /// Submits a job under an id chosen by the caller; each id is submitted once. The journal states the reason. A
    /// result known from an earlier session is returned again by [`Evaluator::next`].
    ///
    /// # Errors
    /// If the evaluator can no longer take jobs.
    fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), EvaluatorError>;

    /// Records what the study found or concluded. The default does nothing.
    ///
    /// # Errors
    /// If an earlier session of the run recorded another entry, or the evaluator can no longer record.
    fn enter(&mut self, _entry: &Entry) -> Result<(), EvaluatorError> {
        Ok(())
    }

    /// Replaces the jobs that the study will probably submit next, likeliest first; idle slots may compute them
    /// ahead. It has no effect on results. The default does nothing.
    ///
    /// # Errors
    /// If the evaluator can no longer take jobs.
    fn anticipate(&mut self, _jobs: Vec<Job>) -> Result<(), EvaluatorError> {
        Ok(())
    }

    /// Returns whether jobs can be computed ahead, that is, whether [`Self::anticipate`] has an effect now.
    fn computes_ahead(&self) -> bool {
        false
    }

    /// Returns the next result. Cancellation-safe: no result is lost if the future is dropped.
    ///
    /// # Errors
    /// If no further result can come.
    fn next(&mut self) -> impl Future<Output = Result<Completed, EvaluatorError>>;

    /// Returns the job numbers assigned in earlier sessions of the run, for studies that number jobs by
    /// content.
    ///
    /// # Errors
    /// If the records of earlier sessions cannot be read.
    fn numbers(&self) -> Result<JobNumbers, EvaluatorError> {
        Ok(JobNumbers::default())
    }

    /// Returns a recent state of the workers and their jobs.
    fn snapshot(&self) -> Snapshot;

    /// Returns the state of the workers and their jobs after every result that [`Self::next`] has returned. The
    /// default is a recent state.
    ///
    /// # Errors
    /// If no further result can come.
    fn current_snapshot(&self) -> impl Future<Output = Result<Snapshot, EvaluatorError>> {
        std::future::ready(Ok(self.snapshot()))
    }
}

/// Extracts the expected kind of answer from a completed job by `take`; `what` names the job's purpose in an
/// error message.
///
/// # Errors
/// If the job failed, or was answered as another kind of job.
pub fn answer<T>(
    completed: Completed,
    take: impl FnOnce(Answer) -> Result<T, UnexpectedAnswer>,
    what: impl FnOnce() -> String,
) -> Result<T, StudyError> {
    let id = completed.id;
    let answer = completed
        .outcome
        .done()
        .map_err(|failure| StudyError::of(failure, what))?;
    take(answer).map_err(|_| StudyError::WrongKind { id })
}
