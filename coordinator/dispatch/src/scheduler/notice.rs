//! What people are told: each case once, with what they can do about it.
use protocol::{
    id::{JobId, WorkerId},
    job::Failure,
    wire,
};
use std::fmt;

/// Most jobs that are named one by one.
const MOST_NAMED: usize = 5;

/// Something worth a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// A worker takes part.
    Joined {
        /// The worker's name.
        worker: WorkerId,
        /// Its machine.
        host: String,
        /// Its slots.
        slots: u32,
    },
    /// A worker left in good order.
    Left {
        /// The worker's name.
        worker: WorkerId,
        /// Why, in the worker's words.
        reason: String,
    },
    /// A worker was lost.
    Lost {
        /// The worker's name.
        worker: WorkerId,
        /// How it showed.
        reason: String,
        /// Jobs that are offered again.
        jobs: usize,
    },
    /// A worker may not take part.
    Refused {
        /// The worker's name.
        worker: WorkerId,
        /// Its machine.
        host: String,
        /// Why, as it was told.
        reason: String,
    },
    /// A worker speaks another version of the wire.
    OtherVersion {
        /// The worker's name.
        worker: WorkerId,
        /// The version.
        version: u8,
    },
    /// Jobs wait and nobody is there.
    NoWorker {
        /// How many wait.
        jobs: usize,
        /// How many workers were refused.
        refused: usize,
    },
    /// Jobs are kept apart from all others because workers were lost that held them.
    Quarantined {
        /// The jobs.
        jobs: Vec<JobId>,
        /// How many workers that held each of them were lost.
        workers: u32,
    },
    /// A job is given up.
    GivenUp {
        /// The job.
        job: JobId,
        /// What happened last.
        failure: Failure,
    },
    /// The coordinator itself did not run for a while.
    Stalled {
        /// For how long \[ms\].
        ms: u64,
    },
}

impl Notice {
    /// Whether nothing needs to be done about it.
    pub const fn is_routine(&self) -> bool {
        matches!(self, Self::Joined { .. } | Self::Left { .. })
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
                    "worker {worker} was lost ({reason}); jobs offered again: {jobs}"
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
            Self::Quarantined { jobs, workers } => {
                let named: Vec<String> =
                    jobs.iter().take(MOST_NAMED).map(JobId::to_string).collect();
                let named = named.join(", ");
                match jobs.len() {
                    0 | 1 => write!(
                        to,
                        "{workers} workers were lost that held job {named}: from now on it runs alone"
                    ),
                    count if count <= MOST_NAMED => write!(
                        to,
                        "{workers} workers were lost that held the jobs {named}: from now on each \
                         runs alone"
                    ),
                    count => write!(
                        to,
                        "{workers} workers were lost that held {count} jobs ({named}, ...): from \
                         now on each runs alone"
                    ),
                }
            }
            Self::GivenUp { job, failure } => write!(to, "job {job} is given up: {failure}"),
            Self::Stalled { ms } => write!(
                to,
                "the coordinator stood still for {ms} ms; no worker is held responsible for it"
            ),
        }
    }
}

/// Why a run cannot go on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Nothing has ever succeeded.
    EverythingFails {
        /// Jobs that failed.
        jobs: u32,
        /// The last failure.
        last: Failure,
    },
}

impl fmt::Display for Stop {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EverythingFails { jobs, last } => write!(
                to,
                "all of the first {jobs} jobs failed and none succeeded; the last one: {last}"
            ),
        }
    }
}
