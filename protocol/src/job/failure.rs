//! What else than its answer can come of a job.
use super::left::Left;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a job could not be done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// It ran longer than its deadline and was ended.
    Deadline {
        /// The deadline \[ms\].
        limit_ms: u64,
        /// What it left until then.
        left: Left,
    },
    /// The process that computed it ended by itself.
    Crashed {
        /// Exit status or signal, in words.
        how: String,
        /// What it left behind.
        left: Left,
    },
    /// The worker that computed it was lost, as often as the retry limit allows.
    Lost {
        /// How many workers were lost over it.
        workers: u32,
    },
    /// The worker will not do this kind of job.
    Refused {
        /// Why.
        reason: String,
    },
    /// The case cannot be built into a model.
    Misconfigured {
        /// Which field of the case.
        field: String,
        /// What is wrong with it and what to do.
        problem: String,
    },
}

impl Failure {
    /// A case or a job that cannot be built into a model: the field, and what is wrong with it.
    pub fn misconfigured(field: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Misconfigured {
            field: field.into(),
            problem: problem.into(),
        }
    }

    /// A process that ended by itself and left nothing.
    pub const fn crashed(how: String) -> Self {
        let left = Left::NONE;
        Self::Crashed { how, left }
    }

    /// A run that was ended at its deadline \[ms\] and left nothing.
    pub const fn deadline(limit_ms: u64) -> Self {
        let left = Left::NONE;
        Self::Deadline { limit_ms, left }
    }

    /// What the run left in its folder, as far as it travelled.
    pub const fn left(&self) -> Option<&Left> {
        match self {
            Self::Deadline { left, .. } | Self::Crashed { left, .. } => Some(left),
            Self::Lost { .. } | Self::Refused { .. } | Self::Misconfigured { .. } => None,
        }
    }

    /// Name of the kind, as written in tables.
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
            Self::Crashed { how, .. } => write!(to, "the process that computed it ended: {how}"),
            Self::Lost { workers } => write!(to, "{workers} workers were lost over it"),
            Self::Refused { reason } => write!(to, "the worker refused it: {reason}"),
            Self::Misconfigured { field, problem } => write!(to, "{field}: {problem}"),
        }
    }
}

/// The answer is that of another kind of job than the one that was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it was answered with the result of a {answered} job")]
pub struct WrongKind {
    /// Name of the kind that was answered.
    pub answered: &'static str,
}
