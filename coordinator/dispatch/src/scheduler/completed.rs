//! Completed job with its result.
use protocol::{id::JobId, job::Outcome, message::Cost};

/// Completed job with its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// Identifier with which the job was submitted.
    pub id: JobId,
    /// Slot time and processor time used by the accepted attempt.
    pub cost: Cost,
    /// Accepted outcome of the job; there is exactly one.
    pub outcome: Outcome,
    /// Whether the result was read from the journal of an earlier process of the run.
    pub replayed: bool,
}
