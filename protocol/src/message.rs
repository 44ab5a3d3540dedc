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
    /// The coordinator does not know the worker, which must announce itself (again).
    Identify,
    /// The worker is admitted to the run that the frame states.
    Admitted {
        /// Number of the coordinator process in that run, counted from 1.
        epoch: u32,
        /// Hash of the case, which the worker must fetch as a blob before any job.
        case: ContentHash,
        /// Length of the encoded case (bytes).
        case_bytes: u64,
    },
    /// The worker is not admitted.
    Refused {
        /// Field of the worker's announcement that does not match the run, and the remedy.
        reason: String,
    },
    /// Job to do; repeating it does no harm (idempotent).
    Run(Box<Assignment>),
    /// The result of the attempt is no longer needed.
    Cancel(Attempt),
    /// The results of these attempts are in the journal; the worker can discard them.
    Stored(Vec<Attempt>),
    /// The run has ended; this coordinator sends no more work.
    Ended,
}

/// Job as dispatched to a worker, with attempt and deadline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assignment {
    /// Job id and dispatch number that the worker must return with the result.
    pub attempt: Attempt,
    /// Time from start to forced termination \[ms\].
    pub deadline_ms: u64,
    /// Job to do.
    pub job: Job,
}

/// Message from a worker to the coordinator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromWorker {
    /// Description of the worker when it joins.
    Announce(Box<Announcement>),
    /// Heartbeat with the attempts that the worker holds.
    Beat(Heartbeat),
    /// Result of an attempt.
    Done(Box<Done>),
    /// The worker is shutting down; its attempts must be dispatched to other workers.
    Leaving {
        /// Reason why the worker leaves, as text.
        reason: String,
    },
}

/// Heartbeat, sent each second; its lists of the attempts that a worker holds are authoritative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heartbeat {
    /// Sequence number, counted from 0.
    pub number: u64,
    /// Hash of the case that the worker has fetched and verified; without a case only [`Job::Nothing`] can be
    /// done.
    pub case: Option<ContentHash>,
    /// Result of the case's reference individual on this worker; without it the worker receives no jobs.
    pub proof: Option<ReferenceResult>,
    /// Attempts being computed in a slot.
    pub running: Vec<Attempt>,
    /// Attempts queued for a slot.
    pub waiting: Vec<Attempt>,
    /// Attempts whose results are not yet acknowledged.
    pub finished: Vec<Attempt>,
}

/// Time that a job occupied its slot; informative only, used for no decision and not part of any digest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cost {
    /// Wall time in the slot \[us\].
    pub wall_us: u64,
    /// Processor time of the slot process during the job \[us\]; 0 if the job gave no answer.
    pub cpu_us: u64,
}

impl Cost {
    /// Returns the wall time in the slot \[s\].
    pub const fn wall_s(self) -> f64 {
        self.wall_us as f64 / 1e6
    }

    /// Returns the processor time \[s\].
    pub const fn cpu_s(self) -> f64 {
        self.cpu_us as f64 / 1e6
    }
}

/// Result of an attempt, kept by the worker until the coordinator acknowledges it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Attempt that the result belongs to.
    pub attempt: Attempt,
    /// Hash of the job that was done, which guards against assigning the result to another job.
    pub work: ContentHash,
    /// Time that the job took.
    pub cost: Cost,
    /// Answer or failure of the job.
    pub outcome: Outcome,
}

/// Message from the worker process to a slot process, over the slot's standard input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToSlot {
    /// The encoded case for all following jobs.
    Case(#[serde(with = "serde_bytes")] Vec<u8>),
    /// Job to do.
    Run(Box<Job>),
}

/// Message from a slot process to its worker process, over the slot's standard output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromSlot {
    /// The slot process is ready.
    Ready,
    /// The slot process has finished a job.
    Done {
        /// Answer or failure of the job.
        outcome: Box<Outcome>,
        /// Processor time of the job \[us\].
        cpu_us: u64,
    },
}
