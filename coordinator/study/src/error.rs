//! Why a study stopped without a result.
use protocol::{
    id::JobId,
    job::{Failure, Word},
};
use search::strategy::SettingsError;
use std::fmt;

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

/// Why a study stopped without a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// Nobody evaluates any more.
    #[error(transparent)]
    Evaluator(#[from] EvaluatorError),
    /// The search was set up with numbers that make no search.
    #[error("the search cannot be set up: {0}")]
    Settings(#[from] SettingsError),
    /// The case cannot be built into a model.
    #[error("the workers cannot build this case: {field}: {problem}")]
    Misconfigured {
        /// Field of the case.
        field: String,
        /// What is wrong with it.
        problem: String,
    },
    /// What is to be differentiated by is unknown.
    #[error("the workers cannot differentiate by this: {problem}")]
    Column {
        /// What is wrong, and what was probably meant.
        problem: String,
    },
    /// The workers do not do this kind of job.
    #[error("the workers refuse this job: {reason}")]
    Refused {
        /// What they say.
        reason: String,
    },
    /// Everything that the search began with failed.
    #[error("all of the first {count} individuals failed: {how}")]
    AllFailed {
        /// How many were tried.
        count: usize,
        /// Which failures, the most frequent first.
        how: String,
        /// The most frequent failure of the physics, if any was.
        physics: Option<Word>,
    },
    /// A parameter set that is to be compared could not be evaluated.
    #[error("{what} could not be evaluated: {failure}")]
    Unavailable {
        /// Which parameter set, and under which condition.
        what: String,
        /// What happened.
        failure: Failure,
    },
    /// A worker answered a job with the result of another kind of job.
    #[error("job {id} was answered with the result of another kind of job")]
    WrongKind {
        /// The job.
        id: JobId,
    },
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
}

impl StudyError {
    /// The error of a failure that every other job would meet too; none for one that concerns
    /// one job alone.
    pub(super) fn hopeless(failure: &Failure) -> Option<Self> {
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

    /// The error of a job that failed where nothing can stand in for it.
    pub(super) fn of(failure: Failure, what: impl FnOnce() -> String) -> Self {
        Self::hopeless(&failure).unwrap_or_else(|| Self::Unavailable {
            what: what(),
            failure,
        })
    }

    /// What to do about it.
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
            Self::AllFailed { physics: None, .. } => {
                "no simulation was even finished: look at the workers' own messages"
            }
            Self::Unavailable { .. } => "the same command tries again",
            Self::WrongKind { .. } => "the worker is of another version: replace it",
            Self::Interrupted => return None,
        };
        Some(text.to_owned())
    }
}
