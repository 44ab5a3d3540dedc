//! Row types of the exported tables.
use journal::event::Finished;
use protocol::{
    id::{JobId, WorkerId},
    job::{Answer, ChannelScore, Counters, Failure, Outcome, Verdict},
    message::Cost,
};

/// Result of a job as recorded in the journal, without residual and curves.
#[derive(Clone, Debug)]
pub(super) struct Brief {
    pub(super) job: JobId,
    pub(super) kind: &'static str,
    /// Number of the coordinator process that dispatched the attempt, and the number of earlier attempts at
    /// the job in that process; `None` for a failure that the coordinator recorded itself.
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
            offered: finished.attempt.attempt.epoch_and_number(),
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

    /// Returns the mean squared error of the first scored channel whose index is among `channels`.
    pub(super) fn mse(&self, channels: &[usize]) -> Option<f64> {
        let mut scores = self.scores.iter();
        let score = scores.find(|score| channels.contains(&score.channel))?;
        Some(score.mse)
    }
}

/// Row of the table `evaluations`: a simulation that the study requested, with its result.
pub(super) struct Evaluated {
    pub(super) generation: Option<u32>,
    pub(super) purpose: String,
    pub(super) condition: String,
    pub(super) genes: Vec<f64>,
    /// Number of effects that the simulation added to those of the case.
    pub(super) effects: usize,
    /// Number of parameters by which the simulation was differentiated.
    pub(super) columns: u32,
    pub(super) result: Brief,
}

/// Row of the table `scores`: score of one channel in one job.
pub(super) struct Scored {
    pub(super) job: JobId,
    pub(super) score: ChannelScore,
}

/// Parameter of an effect that a simulation added to those of the case.
pub(super) struct EffectRow {
    pub(super) job: JobId,
    pub(super) effect: String,
    /// Name and value of the effect's parameter; `None` for an effect whose parameters all have the model's
    /// defaults.
    pub(super) parameter: Option<(String, f64)>,
}

/// Row of the table `events`: event of the run, such as a worker joining.
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

/// Row of the table `run`: name and value of a property of the whole run.
pub(super) struct Fact {
    pub(super) name: String,
    pub(super) value: String,
}
