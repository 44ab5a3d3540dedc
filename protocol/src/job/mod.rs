//! What a worker can be asked to do, and what it answers: one kind per file.
//!
//! A bad candidate is *not* an error: its [`Verdict`] is data for the search and is never
//! retried. [`Failure`] is infrastructure: the job could not be done.
//!
//! # What a new kind of job costs
//! Eight files. Here: a file with what is asked and what is answered, and in this one a variant of
//! [`Job`] and of [`Answer`], its name, and how to take the answer. In `worker/src/handler`: a file
//! that does it and a line in `mod.rs`. In `coordinator/src/study`: a file that asks for it and a line
//! in `mod.rs`. The wire changes with it: `wire::VERSION` and `protocol/tests/wire_form.txt`. Nobody
//! else lists the kinds. Another reply of a simulation is cheaper: a variant of [`Reply`] and of
//! [`Answer`], and a file in `worker/src/handler`.
mod channels;
mod curves;
mod derivative;
mod failure;
mod left;
mod score;
mod simulate;
mod verdict;
mod word;

pub use channels::Observation;
pub use curves::Curves;
pub use derivative::{Column, Derivative, MOST_COLUMNS, Per, single};
pub use failure::{Failure, WrongKind};
pub use left::{Left, Shortened};
pub use score::{ChannelScore, Evaluation};
pub use simulate::{Individual, Numerics, Reply, SimulateSpec};
pub use verdict::{Counters, Reached, Verdict};
pub use word::Word;

use crate::{announce::EffectDescriptor, id::ContentHash, wire};
use serde::{Deserialize, Serialize};

/// Names of the kinds of jobs, simulations by their reply: what workers announce, what tables show,
/// and by what time limits are kept, since one kind takes minutes where others take seconds.
pub mod kind {
    /// Simulate and compare with the records.
    pub const SCORE: &str = "score";
    /// Simulate and return the measured channels.
    pub const CHANNELS: &str = "channels";
    /// Simulate and return everything that can be drawn.
    pub const CURVES: &str = "curves";
    /// What one kind of model alone knows.
    pub const OWN: &str = "own";
    /// Say which effects there are.
    pub const DESCRIBE: &str = "describe";
    /// Do nothing.
    pub const NOTHING: &str = "nothing";

    /// All that a worker of this build does, in the order in which it says so.
    pub const ALL: [&str; 6] = [SCORE, CHANNELS, CURVES, OWN, DESCRIBE, NOTHING];
}

/// One unit of work; a pure function of itself and the case it names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Job {
    /// Simulate an individual.
    Simulate(SimulateSpec),
    /// Do what only the kind of model knows that the case is of; the model's data play no part.
    Own {
        /// Which of its own jobs.
        name: String,
        /// What is asked, as that kind writes it.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// Say which effects the model can add to a machine.
    Describe,
    /// Do nothing, return at once: measures the bus.
    Nothing {
        /// Bytes that travel to the worker.
        #[serde(with = "serde_bytes")]
        payload: Vec<u8>,
        /// Bytes that travel back.
        reply_bytes: u32,
        /// How long the slot is held \[ms\].
        delay_ms: u32,
    },
}

impl Job {
    /// Name of the kind, as workers announce it.
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

    /// What is simulated; none where nothing is.
    pub const fn individual(&self) -> Option<&Individual> {
        match self {
            Self::Simulate(spec) => Some(&spec.individual),
            Self::Own { .. } | Self::Describe | Self::Nothing { .. } => None,
        }
    }

    /// The name of this piece of work: the hash of the encoded job.
    pub fn work_hash(&self) -> ContentHash {
        // a job that cannot be encoded cannot be sent either; all of those share one name
        ContentHash::of(&wire::encode(self).unwrap_or_default())
    }
}

/// What a [`Job`] that was done came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// Of [`Reply::Score`].
    Scored(Evaluation),
    /// Of [`Reply::Channels`].
    Channels(Observation),
    /// Of [`Reply::Curves`].
    Curves(Box<Curves>),
    /// Of [`Job::Own`], as that kind writes it.
    Own(#[serde(with = "serde_bytes")] Vec<u8>),
    /// Of [`Job::Describe`].
    Described(Vec<EffectDescriptor>),
    /// Of [`Job::Nothing`].
    Nothing(#[serde(with = "serde_bytes")] Vec<u8>),
}

/// How to take an answer of the kind that was asked for.
macro_rules! taken {
    ($($name:ident: $variant:ident -> $content:ty, $what:literal;)*) => {$(
        #[doc = $what]
        ///
        /// # Errors
        /// [`WrongKind`] if it is another kind's.
        pub fn $name(self) -> Result<$content, WrongKind> {
            match self {
                Self::$variant(content) => Ok(content),
                other => Err(WrongKind { answered: other.kind() }),
            }
        }
    )*};
}

impl Answer {
    taken! {
        into_scored: Scored -> Evaluation, "The answer to [`Reply::Score`].";
        into_channels: Channels -> Observation, "The answer to [`Reply::Channels`].";
        into_curves: Curves -> Box<Curves>, "The answer to [`Reply::Curves`].";
        into_own: Own -> Vec<u8>, "The answer to [`Job::Own`].";
        into_described: Described -> Vec<EffectDescriptor>, "The answer to [`Job::Describe`].";
        into_nothing: Nothing -> Vec<u8>, "The answer to [`Job::Nothing`].";
    }

    /// Name of the kind of job that it answers, as [`Job::kind`].
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

    /// Agreement with the record; none where nothing was compared.
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

    /// How the simulation ended and what it cost; none where nothing was simulated.
    pub fn simulation(&self) -> Option<(Verdict, Counters)> {
        match self {
            Self::Scored(evaluation) => Some((evaluation.verdict, evaluation.counters)),
            Self::Channels(seen) => Some((seen.verdict, seen.counters)),
            Self::Curves(curves) => Some((curves.verdict, curves.counters)),
            Self::Own(_) | Self::Described(_) | Self::Nothing(_) => None,
        }
    }
}

/// What came of a [`Job`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// It was done.
    Done(Answer),
    /// It could not be done.
    Failed(Failure),
}

impl Outcome {
    /// Name of the kind of job that was done, as [`Job::kind`]; `failed` if it was not.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Done(answer) => answer.kind(),
            Self::Failed(_) => "failed",
        }
    }

    /// The answer, if the job was done.
    pub const fn answer(&self) -> Option<&Answer> {
        match self {
            Self::Done(answer) => Some(answer),
            Self::Failed(_) => None,
        }
    }

    /// The answer, or why there is none.
    ///
    /// # Errors
    /// [`Failure`] if the job could not be done.
    pub fn done(self) -> Result<Answer, Failure> {
        match self {
            Self::Done(answer) => Ok(answer),
            Self::Failed(failure) => Err(failure),
        }
    }

    /// How the simulation ended and what it cost; none where nothing was simulated.
    pub fn simulation(&self) -> Option<(Verdict, Counters)> {
        self.answer()?.simulation()
    }
}

impl From<Result<Answer, Failure>> for Outcome {
    fn from(result: Result<Answer, Failure>) -> Self {
        result.map_or_else(Self::Failed, Self::Done)
    }
}
