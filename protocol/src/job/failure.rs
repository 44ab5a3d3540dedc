//! Reasons why a job ends without an answer.
use super::failure_files::FailureFiles;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Words before the last lines that a failed program printed, at the end of [`Failure::Crashed`].
pub const LAST_OUTPUT: &str = "; its last output:";
/// End of [`Failure::Crashed`] for a program that printed nothing.
pub const NO_OUTPUT: &str = "; it printed nothing";

/// Reason why a job could not be done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// The run of the job exceeded its deadline and was terminated.
    Deadline {
        /// Deadline of the run \[ms\].
        limit_ms: u64,
        /// Files left in the run's folder when it was terminated.
        left: FailureFiles,
    },
    /// The process or the program that computed the job exited, was killed, or wrote nothing usable.
    Crashed {
        /// How the process ended, as a clause with its subject.
        how: String,
        /// Files left in the run's folder when the process ended.
        left: FailureFiles,
    },
    /// The worker was lost on every attempt at the job. Earlier versions recorded this as a result; it is read in
    /// their journals, where such a job counts as not computed, and no longer made.
    Lost {
        /// Number of workers lost while they computed the job.
        workers: u32,
    },
    /// The worker does not accept this kind of job.
    Refused {
        /// Reason given by the worker for not accepting the job.
        reason: String,
    },
    /// The case cannot be built into a model.
    Misconfigured {
        /// Name of the case's field that is wrong.
        field: String,
        /// Description of the error in the field and of its remedy.
        problem: String,
    },
}

impl Failure {
    /// Returns whether an external program failed, whose last output the failure quotes: repeated with the same input
    /// it fails again.
    pub fn is_of_program(&self) -> bool {
        matches!(self, Self::Crashed { how, .. } if how.contains(LAST_OUTPUT) || how.contains(NO_OUTPUT))
    }

    /// Creates a [`Failure::Misconfigured`] from the field of the case or job and the description of the
    /// error.
    pub fn misconfigured(field: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Misconfigured {
            field: field.into(),
            problem: problem.into(),
        }
    }

    /// Creates a [`Failure::Crashed`] for a run that left no files.
    pub const fn crashed(how: String) -> Self {
        let left = FailureFiles::NONE;
        Self::Crashed { how, left }
    }

    /// Creates a [`Failure::Deadline`] with its limit \[ms\] for a run that left no files.
    pub const fn deadline(limit_ms: u64) -> Self {
        let left = FailureFiles::NONE;
        Self::Deadline { limit_ms, left }
    }

    /// Returns the files left in the run's folder, as far as they were transmitted; `None` for failures that
    /// start no run.
    pub const fn files(&self) -> Option<&FailureFiles> {
        match self {
            Self::Deadline { left, .. } | Self::Crashed { left, .. } => Some(left),
            Self::Lost { .. } | Self::Refused { .. } | Self::Misconfigured { .. } => None,
        }
    }

    /// Returns the name of the kind of failure, as written in tables.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Deadline { .. } => "deadline",
            Self::Crashed { .. } => "crashed",
            Self::Lost { .. } => "lost",
            Self::Refused { .. } => "refused",
            Self::Misconfigured { .. } => "misconfigured",
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Deadline { limit_ms, .. } => {
                write!(to, "it ran longer than {:.1} s", *limit_ms as f64 / 1000.0)
            }
            Self::Crashed { how, .. } => to.write_str(how),
            Self::Lost { workers } => write!(to, "{workers} workers were lost over it"),
            Self::Refused { reason } => write!(to, "the worker refused the job: {reason}"),
            Self::Misconfigured { field, problem } => write!(to, "{field}: {problem}"),
        }
    }
}

/// Error: the answer belongs to another kind of job than the one that was dispatched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the worker returned the result of a {answered} job instead of the requested kind")]
pub struct UnexpectedAnswer {
    /// Name of the kind of job to which the received answer belongs.
    pub answered: &'static str,
}
