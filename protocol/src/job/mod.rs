//! What a worker can be asked to do, and what it answers: one kind per file.
//!
//! A bad candidate is *not* an error: its [`Verdict`] is data for the search and is never
//! retried. [`Failure`] is infrastructure: the job could not be done.
pub mod kind;
mod observe;
mod reduce_head;
mod score;
mod simulate;
mod verdict;

pub use observe::{Observation, ObserveSpec, Refinement};
pub use reduce_head::{
    ElementKind, HeadFields, HeadGauge, HeadMesh, HeadMode, LeftOutMode, ModeFamily,
    ReduceHeadSpec, ReducedHead, RopePair, RopeWrap,
};
pub use score::{ChannelScore, Evaluation, ScoreSpec};
pub use simulate::{Energy, Integration, Motion, SimulateSpec, Simulation};
pub use verdict::{Counters, PhysicsFailure, Reached, Verdict};

use crate::announce::EffectDescriptor;
use serde::{Deserialize, Serialize};
use std::fmt;

/// One unit of work; a pure function of itself and the case it names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Job {
    /// Simulate and compare with the records: fitness, and the residual on demand.
    Score(ScoreSpec),
    /// Simulate and return the curves.
    Simulate(SimulateSpec),
    /// Reduce the flexible back head from its mesh to modes and influence lines.
    ReduceHead(Box<ReduceHeadSpec>),
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
    /// Simulate and return the measured channels alone.
    Observe(ObserveSpec),
}

impl Job {
    /// Name of the kind, as workers announce it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Score(_) => kind::SCORE,
            Self::Simulate(_) => kind::SIMULATE,
            Self::Observe(_) => kind::OBSERVE,
            Self::ReduceHead(_) => kind::REDUCE_HEAD,
            Self::Describe => kind::DESCRIBE,
            Self::Nothing { .. } => kind::NOTHING,
        }
    }
}

/// The answer to a [`Job`] that was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// Of [`Job::Score`].
    Scored(Evaluation),
    /// Of [`Job::Simulate`].
    Simulated(Box<Simulation>),
    /// Of [`Job::ReduceHead`].
    HeadReduced(Box<ReducedHead>),
    /// Of [`Job::Describe`].
    Described(Vec<EffectDescriptor>),
    /// Of [`Job::Nothing`].
    Nothing(#[serde(with = "serde_bytes")] Vec<u8>),
    /// The job could not be done.
    Failed(Failure),
    /// Of [`Job::Observe`].
    Observed(Observation),
}

impl Outcome {
    /// Name of the kind of job that it answers, as [`Job::kind`]; `failed` if it was not done.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Scored(_) => kind::SCORE,
            Self::Simulated(_) => kind::SIMULATE,
            Self::Observed(_) => kind::OBSERVE,
            Self::HeadReduced(_) => kind::REDUCE_HEAD,
            Self::Described(_) => kind::DESCRIBE,
            Self::Nothing(_) => kind::NOTHING,
            Self::Failed(_) => "failed",
        }
    }

    /// How the simulation ended and what it cost; none where nothing was simulated.
    pub fn simulation(&self) -> Option<(Verdict, Counters)> {
        match self {
            Self::Scored(evaluation) => Some((evaluation.verdict, evaluation.counters)),
            Self::Simulated(simulation) => Some((simulation.verdict, simulation.counters)),
            Self::Observed(seen) => Some((seen.verdict, seen.counters)),
            Self::HeadReduced(_) | Self::Described(_) | Self::Nothing(_) | Self::Failed(_) => None,
        }
    }

    /// How the simulation ended; none where nothing was simulated.
    pub fn verdict(&self) -> Option<Verdict> {
        self.simulation().map(|(verdict, _)| verdict)
    }
}

/// Why a job could not be done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// It ran longer than its deadline and was ended.
    Deadline {
        /// The deadline \[ms\].
        limit_ms: u64,
    },
    /// The process that computed it ended by itself.
    Crashed {
        /// Exit status or signal, in words.
        how: String,
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
            Self::Deadline { limit_ms } => {
                write!(to, "it ran longer than {:.1} s", *limit_ms as f64 / 1000.0)
            }
            Self::Crashed { how } => write!(to, "the process that computed it ended: {how}"),
            Self::Lost { workers } => write!(to, "{workers} workers were lost over it"),
            Self::Refused { reason } => write!(to, "the worker refused it: {reason}"),
            Self::Misconfigured { field, problem } => write!(to, "{field}: {problem}"),
        }
    }
}
