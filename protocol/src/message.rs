//! Messages between coordinator, worker and slot: one enum per direction.
use crate::{
    announce::Announcement,
    id::{AttemptId, ContentHash, JobId},
    job::{Job, Outcome},
    proof::ReferenceResult,
};
use serde::{Deserialize, Serialize};

/// Dispatch of one job to one worker; leases, results and acknowledgements refer to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Attempt {
    /// Id of the dispatched job.
    pub job: JobId,
    /// Number of the dispatch among those of the same job, from 0.
    pub attempt: AttemptId,
}

/// Message from the coordinator to a worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToWorker {
    /// Request that the worker announce itself (again), since the coordinator does not know it.
    Identify,
    /// Admission of the worker to the run that the frame states.
    Admitted {
        /// Number of the coordinator process within the run, counted from 1; a restarted coordinator has the
        /// next number.
        epoch: u32,
        /// Hash of the case, which the worker must fetch as a blob before any job.
        case: ContentHash,
        /// Length of the encoded case (bytes).
        case_bytes: u64,
    },
    /// Refusal to admit the worker to the run.
    Refused {
        /// Field of the worker's announcement that does not match the run, and the remedy.
        reason: String,
    },
    /// Job that the worker must do; receiving it repeatedly does no harm (idempotent).
    Run(Box<Assignment>),
    /// Cancellation of an attempt whose result is no longer needed.
    Cancel(Attempt),
    /// Confirmation that the results of these attempts are in the journal; the worker can discard them.
    Stored(Vec<Attempt>),
    /// Notice that the run has ended and that this coordinator sends no more work.
    Ended,
}

/// Job as dispatched to a worker, with its attempt number and deadline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assignment {
    /// Job id and dispatch number that the worker must return with the result.
    pub attempt: Attempt,
    /// Time from the start of the job to its forced termination \[ms\].
    pub deadline_ms: u64,
    /// Job that the worker must do.
    pub job: Job,
}

/// Message from a worker to the coordinator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromWorker {
    /// Description of the worker when it joins.
    Announce(Box<Announcement>),
    /// Heartbeat of the worker with the attempts that it holds.
    Beat(Heartbeat),
    /// Result of one attempt at a job.
    Done(Box<Done>),
    /// Notice that the worker is shutting down; its attempts must be dispatched to other workers.
    Leaving {
        /// Reason why the worker leaves, as text.
        reason: String,
    },
}

/// Heartbeat of a worker, sent each second; its lists of the attempts that the worker holds are
/// authoritative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heartbeat {
    /// Sequence number of the heartbeat, counted from 0.
    pub number: u64,
    /// Hash of the case that the worker has fetched and verified; without a case the worker can only do jobs
    /// without computation ([`Job::Nothing`]).
    pub case: Option<ContentHash>,
    /// Result of the case's reference individual on this worker; without it the worker receives no jobs.
    pub proof: Option<ReferenceResult>,
    /// Attempts that slot processes of the worker are computing.
    pub running: Vec<Attempt>,
    /// Attempts that wait in the worker for a free slot process.
    pub waiting: Vec<Attempt>,
    /// Attempts whose results the coordinator has not yet acknowledged.
    pub finished: Vec<Attempt>,
}

/// Wall and processor time of a job in its slot process; informative only, used for no decision and not part
/// of any digest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cost {
    /// Wall time of the job in its slot process \[us\].
    pub wall_us: u64,
    /// Processor time of the slot process during the job \[us\]; 0 if the job gave no answer.
    pub cpu_us: u64,
}

impl Cost {
    /// Returns the wall time of the job in its slot process \[s\].
    pub const fn wall_s(self) -> f64 {
        self.wall_us as f64 / 1e6
    }

    /// Returns the processor time of the job \[s\].
    pub const fn cpu_s(self) -> f64 {
        self.cpu_us as f64 / 1e6
    }
}

/// Result of one attempt at a job, kept by the worker until the coordinator acknowledges it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Attempt that the result belongs to.
    pub attempt: Attempt,
    /// Hash of the job that was done, which guards against assigning the result to another job.
    pub work: ContentHash,
    /// Wall and processor time of the job.
    pub cost: Cost,
    /// Answer or failure of the job.
    pub outcome: Outcome,
}

/// Message from the worker process to a slot process, over the slot's standard input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToSlot {
    /// Encoded case to which all following jobs refer.
    Case(#[serde(with = "serde_bytes")] Vec<u8>),
    /// Job that the slot process must do.
    Run(Box<Job>),
}

/// Message from a slot process to its worker process, over the slot's standard output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromSlot {
    /// Notice that the slot process has started and accepts messages.
    Ready,
    /// Result of a job that the slot process has finished.
    Done {
        /// Answer or failure of the job.
        outcome: Box<Outcome>,
        /// Processor time of the job \[us\].
        cpu_us: u64,
    },
}
