//! Everything that enters the journal. Readers of a run are folds over a stream of these.
use crate::{
    id::{ContentHash, JobId, RunId, WorkerId},
    job::Outcome,
    message::Attempt,
};
use serde::{Deserialize, Serialize};

/// What decides the result of a run; a run is only resumed with the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunHeader {
    /// Which command the run belongs to, as `calibrate`.
    pub kind: String,
    /// Hash of the encoded case.
    pub case: ContentHash,
    /// Canonical JSON of everything else that decides the result.
    pub settings: String,
}

/// One line of a run's history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// First record: what the run is.
    Begun {
        /// Its name on the wire.
        run: RunId,
        /// What decides its result.
        header: RunHeader,
    },
    /// A coordinator process took the run over.
    Opened {
        /// Counts the processes from 1.
        epoch: u32,
        /// When [ms since 1970 UTC].
        at_unix_ms: u64,
    },
    /// A worker was admitted.
    Joined {
        /// The worker.
        worker: WorkerId,
        /// Its machine.
        host: String,
        /// Its slots.
        slots: u32,
        /// Its numerics.
        model_digest: String,
    },
    /// A worker left or was lost.
    Left {
        /// The worker.
        worker: WorkerId,
        /// Why, in words.
        reason: String,
    },
    /// A job has its one accepted result.
    Finished(Box<Finished>),
    /// The coordinator ended the run by itself.
    Closed,
}

/// The one accepted result of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// The attempt that brought it.
    pub attempt: Attempt,
    /// Hash of the encoded job.
    pub work: ContentHash,
    /// Who did it; none for a failure that the coordinator states itself.
    pub worker: Option<WorkerId>,
    /// Time in the slot \[us\].
    pub wall_us: u64,
    /// What came out.
    pub outcome: Outcome,
}

impl Finished {
    /// The job this answers.
    pub const fn job(&self) -> JobId {
        self.attempt.job
    }
}
