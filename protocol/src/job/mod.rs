//! Kinds of jobs that a worker can do, and their answers: one kind per file.
//!
//! An infeasible individual is *not* an error: its [`Verdict`] is data for the search and the job is never
//! retried. A [`Failure`] concerns the infrastructure: the job could not be done.
//!
//! # Adding a kind of job
//! Eight files change. Here: a new file with request and answer, and in this file a variant of [`Job`] and of
//! [`Answer`], its name, and the function that extracts the answer. In `worker/src/handler`: a file that does
//! the job and a line in `mod.rs`. In `coordinator/src/study`: a file that requests it and a line in
//! `mod.rs`. The wire format changes too: `wire::VERSION` and `protocol/tests/wire_form.txt`. No other place
//! lists the kinds. Another reply of a simulation needs less: a variant of [`Reply`] and of [`Answer`], and a
//! file in `worker/src/handler`.
mod channels;
mod curves;
mod derivative;
pub mod division;
mod failure;
mod failure_files;
mod identifier;
mod score;
mod simulate;
mod verdict;

pub use channels::Observation;
pub use curves::Curves;
pub use derivative::{Column, Derivative, MAX_COLUMNS, Per, to_single_precision};
pub use failure::{Failure, LAST_OUTPUT, NO_OUTPUT, UnexpectedAnswer};
pub use failure_files::{FailureFiles, TruncatedFile};
pub use identifier::Identifier;
pub use score::{ChannelScore, Evaluation};
pub use simulate::{Individual, Numerics, Reply, SimulateSpec};
pub use verdict::{Counters, Reached, Verdict};

use crate::{announce::EffectDescriptor, id::ContentHash, wire};
use serde::{Deserialize, Serialize};

/// Names of the kinds of jobs, with one name per reply of a simulation. Workers announce these names, tables
/// show them, and time limits are kept by them, since some kinds take minutes and others seconds.
pub mod kind {
    /// Kind of job that simulates and compares with the measured records.
    pub const SCORE: &str = "score";
    /// Kind of job that simulates and returns the curves of the measured channels.
    pub const CHANNELS: &str = "channels";
    /// Kind of job that simulates and returns everything that can be drawn.
    pub const CURVES: &str = "curves";
    /// Kind of job that only one model kind understands (`Job::Own`).
    pub const OWN: &str = "own";
    /// Kind of job that lists the effects that the model can add.
    pub const DESCRIBE: &str = "describe";
    /// Kind of job that does nothing (`Job::Nothing`), for measurements of the bus.
    pub const NOTHING: &str = "nothing";

    /// All kinds of jobs that a worker of this build can do, in the order of its announcement.
    pub const ALL: [&str; 6] = [SCORE, CHANNELS, CURVES, OWN, DESCRIBE, NOTHING];
}

/// Unit of work: its answer is a pure function of the job and of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Job {
    /// Simulate an individual under one condition.
    Simulate(SimulateSpec),
    /// Do a job that only the case's model kind understands.
    Own {
        /// Name of the job within those defined by the model kind.
        name: String,
        /// Request in an encoding that only the model kind understands.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// List the effects that the model can add to a machine.
    Describe,
    /// Do nothing and return; measures latency and throughput of the bus.
    Nothing {
        /// Bytes sent to the worker as ballast.
        #[serde(with = "serde_bytes")]
        payload: Vec<u8>,
        /// Number of bytes that the worker sends back.
        reply_bytes: u32,
        /// Time for which the job occupies the worker's slot \[ms\].
        delay_ms: u32,
    },
}

impl Job {
    /// Returns the name of the kind of job, as workers announce it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Simulate(spec) => match spec.reply {
                Reply::Score { .. } => kind::SCORE,
                Reply::Channels => kind::CHANNELS,
                Reply::Curves { .. } => kind::CURVES,
            },
            Self::Own { .. } => kind::OWN,
            Self::Describe => kind::DESCRIBE,
            Self::Nothing { .. } => kind::NOTHING,
        }
    }

    /// Returns the individual that the job simulates; `None` for a job without a simulation.
    pub const fn individual(&self) -> Option<&Individual> {
        match self {
            Self::Simulate(spec) => Some(&spec.individual),
            Self::Own { .. } | Self::Describe | Self::Nothing { .. } => None,
        }
    }

    /// Returns the number of parameters by which the job differentiates its simulation.
    pub const fn columns(&self) -> usize {
        match self {
            Self::Simulate(spec) => spec.columns.len(),
            Self::Own { .. } | Self::Describe | Self::Nothing { .. } => 0,
        }
    }

    /// Returns the hash of the encoded job, by which equal jobs are recognised.
    pub fn work_hash(&self) -> ContentHash {
        // a job that cannot be encoded cannot be sent either; all of those share one name
        ContentHash::of(&wire::encode(self).unwrap_or_default())
    }
}

/// Answer of a worker to a [`Job`] that was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// Answer to [`Reply::Score`].
    Scored(Evaluation),
    /// Answer to [`Reply::Channels`].
    Channels(Observation),
    /// Answer to [`Reply::Curves`].
    Curves(Box<Curves>),
    /// Answer to [`Job::Own`], encoded by the kind of model.
    Own(#[serde(with = "serde_bytes")] Vec<u8>),
    /// Answer to [`Job::Describe`].
    Described(Vec<EffectDescriptor>),
    /// Answer to [`Job::Nothing`].
    Nothing(#[serde(with = "serde_bytes")] Vec<u8>),
}

/// Defines a method of [`Answer`] that returns the content of one variant.
macro_rules! taken {
    ($($name:ident: $variant:ident -> $content:ty, $what:literal;)*) => {$(
        #[doc = $what]
        /// # Errors
        /// [`UnexpectedAnswer`] if the answer belongs to another kind of job.
        pub fn $name(self) -> Result<$content, UnexpectedAnswer> {
            match self {
                Self::$variant(content) => Ok(content),
                other => Err(UnexpectedAnswer { answered: other.kind() }),
            }
        }
    )*};
}

impl Answer {
    taken! {
        into_scored: Scored -> Evaluation, "Returns the answer to [`Reply::Score`].";
        into_channels: Channels -> Observation, "Returns the answer to [`Reply::Channels`].";
        into_curves: Curves -> Box<Curves>, "Returns the answer to [`Reply::Curves`].";
        into_own: Own -> Vec<u8>, "Returns the answer to [`Job::Own`].";
        into_described: Described -> Vec<EffectDescriptor>, "Returns the answer to [`Job::Describe`].";
        into_nothing: Nothing -> Vec<u8>, "Returns the answer to [`Job::Nothing`].";
    }

    /// Returns the name of the kind of job that was answered, as [`Job::kind`] does.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Scored(_) => kind::SCORE,
            Self::Channels(_) => kind::CHANNELS,
            Self::Curves(_) => kind::CURVES,
            Self::Own(_) => kind::OWN,
            Self::Described(_) => kind::DESCRIBE,
            Self::Nothing(_) => kind::NOTHING,
        }
    }

    /// Returns the comparison with the measured records; `None` for the answer to a job that compares
    /// nothing.
    pub const fn evaluation(&self) -> Option<&Evaluation> {
        match self {
            Self::Scored(evaluation) => Some(evaluation),
            Self::Channels(_)
            | Self::Curves(_)
            | Self::Own(_)
            | Self::Described(_)
            | Self::Nothing(_) => None,
        }
    }

    /// Returns the verdict and the work counters of the simulation; `None` for a job without a simulation.
    pub fn simulation(&self) -> Option<(Verdict, Counters)> {
        match self {
            Self::Scored(evaluation) => Some((evaluation.verdict, evaluation.counters)),
            Self::Channels(seen) => Some((seen.verdict, seen.counters)),
            Self::Curves(curves) => Some((curves.verdict, curves.counters)),
            Self::Own(_) | Self::Described(_) | Self::Nothing(_) => None,
        }
    }
}

/// Result of a [`Job`]: its answer or the reason of its failure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// The job was done, with this answer.
    Done(Answer),
    /// The job could not be done, for this reason.
    Failed(Failure),
}

impl Outcome {
    /// Returns the name of the kind of job that was done, as [`Job::kind`] does; `failed` if the job failed.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Done(answer) => answer.kind(),
            Self::Failed(_) => "failed",
        }
    }

    /// Returns the answer if the job was done; `None` if it failed.
    pub const fn answer(&self) -> Option<&Answer> {
        match self {
            Self::Done(answer) => Some(answer),
            Self::Failed(_) => None,
        }
    }

    /// Converts the outcome into a `Result` with the answer.
    ///
    /// # Errors
    /// [`Failure`] if the job could not be done.
    pub fn done(self) -> Result<Answer, Failure> {
        match self {
            Self::Done(answer) => Ok(answer),
            Self::Failed(failure) => Err(failure),
        }
    }

    /// Returns the verdict and the work counters of the simulation; `None` for a failed job or a job without
    /// a simulation.
    pub fn simulation(&self) -> Option<(Verdict, Counters)> {
        self.answer()?.simulation()
    }
}

impl From<Result<Answer, Failure>> for Outcome {
    fn from(result: Result<Answer, Failure>) -> Self {
        result.map_or_else(Self::Failed, Self::Done)
    }
}
