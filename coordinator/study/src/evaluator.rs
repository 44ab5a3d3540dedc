//! What a study needs of whoever evaluates: take jobs, give results, say who is at work.
use super::error::{EvaluatorError, StudyError};
use super::job_number::JobNumbers;
use dispatch::scheduler::Completed;
use protocol::{
    event::Spent,
    id::JobId,
    job::{Answer, Job, WrongKind},
};
use std::time::Duration;

/// Evaluates jobs in any order.
pub trait Evaluator {
    /// Takes a job. The id is the caller's; each is submitted once. A result that is known from
    /// an earlier session is given again by [`Evaluator::next`].
    ///
    /// # Errors
    /// If the evaluator can no longer take jobs.
    fn submit(&mut self, id: JobId, job: Job) -> Result<(), EvaluatorError>;

    /// The next result. Dropping the future loses nothing.
    ///
    /// # Errors
    /// If no further result can come.
    fn next(&mut self) -> impl Future<Output = Result<Completed, EvaluatorError>>;

    /// Numbers that jobs of earlier sessions have, for studies that number jobs by their content.
    ///
    /// # Errors
    /// If what earlier sessions left cannot be read.
    fn numbers(&self) -> Result<JobNumbers, EvaluatorError> {
        Ok(JobNumbers::default())
    }

    /// Who is at work, now.
    fn crew(&self) -> Crew;
}

/// The answer to a job of the kind that was asked for, as `take` takes it; `what` it was about.
///
/// # Errors
/// If the job failed, or was answered as another kind of job.
pub fn answer<T>(
    completed: Completed,
    take: impl FnOnce(Answer) -> Result<T, WrongKind>,
    what: impl FnOnce() -> String,
) -> Result<T, StudyError> {
    let id = completed.id;
    let answer = completed
        .outcome
        .done()
        .map_err(|failure| StudyError::of(failure, what))?;
    take(answer).map_err(|_| StudyError::WrongKind { id })
}

/// Everyone who evaluates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crew {
    /// Everyone who was seen in this session.
    pub workers: Vec<WorkerStatus>,
    /// Jobs that wait for a worker.
    pub queued: usize,
    /// Jobs that are being computed.
    pub running: usize,
    /// How all slots spent their time in this session.
    pub spent: Spent,
    /// For how long anybody has been computing in this session: waiting for workers, and for them to
    /// build the model, is not part of it.
    pub computing: Duration,
}

/// One worker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorkerStatus {
    /// Its name.
    pub name: String,
    /// Where it runs.
    pub host: String,
    /// Whether it is attached now.
    pub attached: bool,
    /// Simulations it runs at a time.
    pub slots: u32,
    /// Slots that are computing now.
    pub busy: u32,
    /// Jobs whose result was accepted.
    pub done: u64,
    /// Jobs that could not be done there.
    pub failed: u64,
    /// Time its slots spent computing, summed over slots (s).
    pub busy_s: f64,
    /// Time it was attached (s).
    pub present_s: f64,
}
