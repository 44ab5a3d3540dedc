//! What the rows of the tables are made of.
use dispatch::scheduler;
use protocol::{
    event::Finished,
    id::{JobId, WorkerId},
    job::{Answer, ChannelScore, Counters, Failure, Outcome, Verdict},
    message::Cost,
};

/// What a journal says of one result, without its curves.
#[derive(Clone, Debug)]
pub(super) struct Brief {
    pub(super) job: JobId,
    pub(super) kind: &'static str,
    /// The process of the run that offered it, and the offers of its job that went before there.
    pub(super) offered: Option<(u32, u32)>,
    pub(super) worker: Option<WorkerId>,
    pub(super) cost: Cost,
    pub(super) simulated: Option<(Verdict, Counters)>,
    pub(super) fitness: Option<f64>,
    pub(super) scores: Vec<ChannelScore>,
    pub(super) failure: Option<Failure>,
}

impl Brief {
    pub(super) fn of(finished: &Finished) -> Self {
        let evaluation = finished.outcome.answer().and_then(Answer::evaluation);
        let failure = match &finished.outcome {
            Outcome::Failed(why) => Some(why.clone()),
            Outcome::Done(_) => None,
        };
        Self {
            job: finished.job(),
            kind: finished.outcome.kind(),
            offered: scheduler::offered(finished.attempt.attempt),
            worker: finished.worker,
            cost: finished.cost,
            simulated: finished.outcome.simulation(),
            fitness: evaluation.map(|evaluation| evaluation.fitness),
            scores: evaluation.map_or_else(Vec::new, |evaluation| evaluation.channels.clone()),
            failure,
        }
    }

    pub(super) fn counters(&self) -> Option<Counters> {
        self.simulated.map(|(_, counters)| counters)
    }

    /// Mean squared error of the one of some channels that was scored.
    pub(super) fn mse(&self, channels: &[usize]) -> Option<f64> {
        let mut scores = self.scores.iter();
        let score = scores.find(|score| channels.contains(&score.channel))?;
        Some(score.mse)
    }
}

/// One simulation of the run: what was asked, and what came of it.
pub(super) struct Evaluated {
    pub(super) generation: Option<u32>,
    pub(super) purpose: String,
    pub(super) condition: String,
    pub(super) genes: Vec<f64>,
    /// How many effects it had beside those of the case.
    pub(super) effects: usize,
    pub(super) result: Brief,
}

/// Agreement of one channel.
pub(super) struct Scored {
    pub(super) job: JobId,
    pub(super) score: ChannelScore,
}

/// A parameter of an effect that a simulation had beside those of the case.
pub(super) struct Added {
    pub(super) job: JobId,
    pub(super) effect: String,
    /// None for an effect all of whose parameters are the model's.
    pub(super) parameter: Option<(String, f64)>,
}

/// Something that happened to the run.
#[derive(Default)]
pub(super) struct Happened {
    pub(super) at_byte: u64,
    pub(super) process: Option<u32>,
    pub(super) at_unix_ms: Option<u64>,
    pub(super) event: &'static str,
    pub(super) worker: Option<WorkerId>,
    pub(super) host: Option<String>,
    pub(super) slots: Option<u32>,
    pub(super) detail: Option<String>,
}

/// Something that is known of the run as a whole.
pub(super) struct Fact {
    pub(super) name: String,
    pub(super) value: String,
}
