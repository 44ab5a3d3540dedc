//! What a study needs of whoever evaluates: take jobs, give results, say who is at work.
use super::StudyError;
use protocol::{
    event::Spent,
    job::{Job, Outcome, Simulation},
};
use std::fmt;

/// Evaluates jobs in any order.
pub trait Evaluator {
    /// Takes a job. The id is the caller's; each is submitted once. A result that is known from
    /// an earlier session is given again by [`Evaluator::next`].
    ///
    /// # Errors
    /// If the evaluator can no longer take jobs.
    fn submit(&mut self, id: u64, job: Job) -> Result<(), EvaluatorError>;

    /// The next result. Dropping the future loses nothing.
    ///
    /// # Errors
    /// If no further result can come.
    fn next(&mut self) -> impl Future<Output = Result<Completed, EvaluatorError>>;

    /// Who is at work, now.
    fn crew(&self) -> Crew;
}

/// A job that is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// The id it was submitted with.
    pub id: u64,
    /// Its outcome.
    pub outcome: Outcome,
    /// Whether the result is from an earlier session.
    pub replayed: bool,
}

impl Completed {
    /// The simulation that was asked for.
    pub(super) fn simulated(self, what: impl FnOnce() -> String) -> Result<Simulation, StudyError> {
        match self.outcome {
            Outcome::Simulated(simulation) => Ok(*simulation),
            Outcome::Failed(failure) => Err(StudyError::of(failure, what)),
            Outcome::Scored(_)
            | Outcome::Observed(_)
            | Outcome::Described(_)
            | Outcome::HeadReduced(_)
            | Outcome::Nothing(_) => Err(StudyError::WrongKind { id: self.id }),
        }
    }
}

/// Why an evaluator gave up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EvaluatorError {
    /// What happened.
    pub message: String,
    /// What to do about it, if anything.
    pub help: Option<String>,
}

impl fmt::Display for EvaluatorError {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.message)
    }
}

impl std::error::Error for EvaluatorError {}

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
