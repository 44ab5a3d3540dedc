//! A job with its result, as whoever asked for it gets it.
use protocol::{id::JobId, job::Outcome, message::Cost};

/// A job that is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// The job, by the name that it was submitted with.
    pub id: JobId,
    /// What it took of the slot that did it.
    pub cost: Cost,
    /// Its one accepted outcome.
    pub outcome: Outcome,
    /// Whether the result comes from the journal, of an earlier process of the run.
    pub replayed: bool,
}
