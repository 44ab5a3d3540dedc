//! Notices to the user: each situation is reported once, with the remedy.
use protocol::{
    id::{JobId, WorkerId},
    job::Failure,
    wire,
};
use std::{fmt, time::Duration};

/// Largest number of jobs that a notice lists by id.
const MOST_NAMED: usize = 5;

/// Event reported to the user in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// A worker joined the run.
    Joined {
        /// Identifier of the worker that joined.
        worker: WorkerId,
        /// Host name of the worker.
        host: String,
        /// Number of slots of the worker.
        slots: u32,
    },
    /// A worker left in an orderly way.
    Left {
        /// Identifier of the worker that left.
        worker: WorkerId,
        /// Reason given by the worker.
        reason: String,
    },
    /// A worker was lost.
    Lost {
        /// Identifier of the lost worker.
        worker: WorkerId,
        /// Symptom by which the loss was detected.
        reason: String,
        /// Number of jobs of the lost worker that are requeued.
        jobs: usize,
    },
    /// A worker was refused admission.
    Refused {
        /// Identifier of the refused worker.
        worker: WorkerId,
        /// Host name of the worker.
        host: String,
        /// Reason for the refusal, as sent to the worker.
        reason: String,
    },
    /// A worker uses another version of the wire protocol.
    OtherVersion {
        /// Identifier of the worker with the other protocol version.
        worker: WorkerId,
        /// Version found in the worker's message.
        version: u8,
    },
    /// Jobs are waiting but no worker is connected.
    NoWorker {
        /// Number of waiting jobs.
        jobs: usize,
        /// Number of workers that were refused admission.
        refused: usize,
    },
    /// Jobs are quarantined (run alone on a worker) because workers that held them were lost.
    Quarantined {
        /// Quarantined jobs.
        jobs: Vec<JobId>,
        /// Number of lost workers that held each of the jobs.
        workers: u32,
    },
    /// A job waits for a worker that joins from now on, because all workers that held it were lost.
    AwaitsWorker {
        /// Job that waits.
        job: JobId,
        /// Number of lost workers that held the job.
        losses: u32,
        /// Last of these workers.
        worker: WorkerId,
        /// Host of the last of these workers.
        host: String,
        /// Time without a result after which the run ends if no other job is left.
        limit: Duration,
    },
    /// A job is abandoned after too many failures.
    GivenUp {
        /// Abandoned job.
        job: JobId,
        /// Last failure of the job.
        failure: Failure,
    },
    /// The coordinator process itself did not run for a while.
    Stalled {
        /// Duration of the stall \[ms\].
        ms: u64,
    },
}

impl Notice {
    /// Returns whether the notice requires no action by the user, or the outcome of a job says the same.
    pub const fn is_routine(&self) -> bool {
        matches!(
            self,
            Self::Joined { .. } | Self::Left { .. } | Self::GivenUp { .. }
        )
    }
}

impl fmt::Display for Notice {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joined {
                worker,
                host,
                slots,
            } => {
                write!(to, "worker {worker} on {host} joined with {slots} slots")
            }
            Self::Left { worker, reason } => write!(to, "worker {worker} left: {reason}"),
            Self::Lost {
                worker,
                reason,
                jobs,
            } => {
                write!(
                    to,
                    "worker {worker} was lost ({reason}); jobs requeued: {jobs}"
                )
            }
            Self::Refused {
                worker,
                host,
                reason,
            } => {
                write!(to, "worker {worker} on {host} was refused: {reason}")
            }
            Self::OtherVersion { worker, version } => {
                let error = wire::WireError::Version { found: *version };
                write!(to, "worker {worker} was refused: {error}")
            }
            Self::NoWorker { jobs, refused: 0 } => write!(
                to,
                "no worker is connected and {jobs} jobs wait: start horsehead-worker --connect \
                 LOCATOR on any machine that reaches this one"
            ),
            Self::NoWorker { jobs, refused } => write!(
                to,
                "every worker was refused ({refused}) and {jobs} jobs wait: use the same build of \
                 horsehead and horsehead-worker everywhere"
            ),
            Self::Quarantined { jobs, workers } => quarantined(to, jobs, *workers),
            Self::AwaitsWorker {
                job,
                losses,
                worker,
                host,
                limit,
            } => write!(
                to,
                "job {job} waits for a worker that joins from now on: {losses} workers that held it were lost, the \
                 last one {worker} on {host}. The worker's log (`horsehead workers logs --ssh {host}`) or the \
                 kernel's log there (out of memory) shows why. The other jobs go on; when none is left and {} s \
                 pass without a result, the run ends and the same command resumes it",
                limit.as_secs()
            ),
            Self::GivenUp { job, failure } => write!(to, "job {job} was abandoned: {failure}"),
            Self::Stalled { ms } => write!(
                to,
                "the coordinator was suspended for {ms} ms; no worker is counted as lost because of this"
            ),
        }
    }
}

fn quarantined(to: &mut fmt::Formatter<'_>, jobs: &[JobId], workers: u32) -> fmt::Result {
    let named: Vec<String> = jobs.iter().take(MOST_NAMED).map(JobId::to_string).collect();
    let named = named.join(", ");
    match jobs.len() {
        0 | 1 => write!(
            to,
            "{workers} workers that held job {named} were lost: the job now runs on a worker without other jobs"
        ),
        count if count <= MOST_NAMED => write!(
            to,
            "{workers} workers were lost that held the jobs {named}: from now on each runs alone"
        ),
        count => write!(
            to,
            "{workers} workers were lost that held {count} jobs ({named}, ...): from now on each runs alone"
        ),
    }
}

/// Reason why a run cannot continue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// Every job so far has failed.
    EverythingFails {
        /// Number of failed jobs.
        jobs: u32,
        /// Failure of the most recent job.
        last: Failure,
    },
    /// A job has no result because all workers that held it were lost, and nothing else is left to do.
    WorkersLost {
        /// Job without a result.
        job: JobId,
        /// Number of lost workers that held the job.
        workers: u32,
        /// Time for which the run waited.
        limit: Duration,
    },
}

impl fmt::Display for StopReason {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EverythingFails { jobs, last } => {
                write!(to, "the first {jobs} jobs all failed; last failure: {last}")
            }
            Self::WorkersLost {
                job,
                workers,
                limit,
            } => write!(
                to,
                "job {job} has no result: {workers} workers that held it were lost, and no result came within {} s \
                 (--pause-limit); nothing was recorded for it, so the run can be resumed once the cause is removed",
                limit.as_secs()
            ),
        }
    }
}
