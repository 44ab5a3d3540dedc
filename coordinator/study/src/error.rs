//! Errors that end a study without a result.
use protocol::{
    id::JobId,
    job::{Failure, Identifier},
};
use search::strategy::SettingsError;
use std::fmt;

/// Error of an evaluator that can no longer compute jobs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EvaluatorError {
    /// Description of the evaluator's error in words.
    pub message: String,
    /// Remedy for the evaluator's error, if there is one.
    pub help: Option<String>,
    /// Whether a later session may add results to those that the run has.
    pub can_go_on: bool,
}

impl fmt::Display for EvaluatorError {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.message)
    }
}

impl std::error::Error for EvaluatorError {}

/// Error that ends a study without a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The evaluator can no longer compute jobs.
    #[error(transparent)]
    Evaluator(#[from] EvaluatorError),
    /// The settings of the search are invalid.
    #[error("the search cannot be set up: {0}")]
    Settings(#[from] SettingsError),
    /// The workers cannot build a model from the case.
    #[error("the workers cannot build this case: {field}: {problem}")]
    Misconfigured {
        /// Name of the case's field that is invalid.
        field: String,
        /// Description of the problem in the field of the case.
        problem: String,
    },
    /// The study was asked for derivatives with respect to a parameter that does not exist.
    #[error("the workers cannot differentiate by this: {problem}")]
    Column {
        /// Description of the unknown parameter, with the most similar known name.
        problem: String,
    },
    /// The workers do not support a kind of job that the study needs.
    #[error("the workers refuse this job: {reason}")]
    Refused {
        /// Reason given by the workers.
        reason: String,
    },
    /// All individuals at the beginning of the search failed.
    #[error("all of the first {count} individuals failed: {how}")]
    AllFailed {
        /// Number of individuals that were evaluated.
        count: usize,
        /// Failures of the individuals in words, with counts, the most frequent first.
        how: String,
        /// Most frequent failure of the simulated machine; `None` if all failures have other reasons.
        physics: Option<Identifier>,
        /// Whether an external program failed.
        of_program: bool,
    },
    /// An individual that is to be compared could not be evaluated.
    #[error("{what} could not be evaluated: {failure}")]
    Unavailable {
        /// Name of the individual and of the condition that could not be evaluated.
        what: String,
        /// Reason why the job of the individual failed.
        failure: Failure,
    },
    /// A worker answered a job with the result of another kind of job.
    #[error("job {id} was answered with the result of another kind of job")]
    WrongKind {
        /// Number of the job that was answered wrongly.
        id: JobId,
    },
    /// The user stopped the study.
    #[error("interrupted")]
    Interrupted,
}

/// Remedy for an external program that fails, which it does again with the same input.
pub const PROGRAM_REMEDY: &str = "correct the program, or the files that it reads and writes; if one of the case's files changes, run \
    `horsehead allow CASE` again. `horsehead simulate CASE` runs it once";

impl StudyError {
    /// Converts a job failure that would affect every other job into an error; returns none for a failure of
    /// one job alone.
    pub(super) fn from_systematic_failure(failure: &Failure) -> Option<Self> {
        match failure.clone() {
            Failure::Misconfigured { field, problem } if field.starts_with("columns") => {
                Some(Self::Column { problem })
            }
            Failure::Misconfigured { field, problem } => {
                Some(Self::Misconfigured { field, problem })
            }
            Failure::Refused { reason } => Some(Self::Refused { reason }),
            Failure::Deadline { .. } | Failure::Crashed { .. } | Failure::Lost { .. } => None,
        }
    }

    /// Converts the failure of a job that the study cannot do without into an error; `what` names the
    /// individual or purpose of the job.
    pub(super) fn of(failure: Failure, what: impl FnOnce() -> String) -> Self {
        Self::from_systematic_failure(&failure).unwrap_or_else(|| Self::Unavailable {
            what: what(),
            failure,
        })
    }

    /// Returns the remedy for the error, if there is one.
    pub fn help(&self) -> Option<String> {
        let text = match self {
            Self::Evaluator(error) => return error.help.clone(),
            Self::Settings(_) => "correct that setting; `--preset paper` is always valid",
            Self::Misconfigured { .. } => {
                "correct that field of case.toml; `horsehead case check CASE` lists all that is wrong"
            }
            Self::Column { .. } => {
                "give unknowns of the case, or EFFECT.PARAMETER of an effect that the workers know"
            }
            Self::Refused { .. } => "start workers of the same version as this program",
            Self::AllFailed {
                physics: Some(_), ..
            } => {
                "`horsehead simulate CASE` shows how the recommended individual ends; narrower \
                 bounds in the case, or another --seed, may help"
            }
            Self::AllFailed {
                of_program: true, ..
            } => PROGRAM_REMEDY,
            Self::Unavailable { failure, .. } if failure.is_of_program() => PROGRAM_REMEDY,
            Self::Unavailable {
                failure: Failure::Deadline { .. },
                ..
            } => {
                "the limit is `deadline_s` of the case, or `wall_s` of the program's entry in the list of allowed programs"
            }
            Self::AllFailed { .. } | Self::Unavailable { .. } => "the same command tries again",
            Self::WrongKind { .. } => {
                "the worker has another version: install the version of this program on its host"
            }
            Self::Interrupted => return None,
        };
        Some(text.to_owned())
    }
}
