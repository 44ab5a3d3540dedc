//! Interface to the simulation of batches of points.
use crate::record::measured::{Curves, Record, Recorded};
use protocol::job::{Observation, SimulateSpec, Verdict};

/// Stage of a diagnosis, for progress reports, timing and budgets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Global search for the narrow minimum in which resonances fit.
    Basin,
    /// Fit of all unknowns in the metric of the tests.
    Recalibrate,
    /// Numerical check: size of the discretisation error.
    Preflight,
    /// Localisation of the residual.
    Where,
    /// Signatures and tests of all effects.
    Test,
    /// Refits of the candidate effects.
    Refit,
    /// Validation: misfit before and after adding the effects.
    Show,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 7] = [
        Self::Basin,
        Self::Recalibrate,
        Self::Preflight,
        Self::Where,
        Self::Test,
        Self::Refit,
        Self::Show,
    ];

    /// Returns the name of the stage as shown to users.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Basin => "global search",
            Self::Recalibrate => "recalibration",
            Self::Preflight => "numerical check",
            Self::Where => "where",
            Self::Test => "what",
            Self::Refit => "refits",
            Self::Show => "show",
        }
    }
}

/// Simulator of batches of experiments.
pub trait Laboratory {
    /// Reason why no further experiment can be simulated.
    type Error;

    /// Returns whether observations contain the derivatives that a job requests, or the reason for their
    /// absence; if false, finite differences of whole experiments are used instead.
    fn differentiates(&self) -> bool {
        false
    }

    /// Returns whether a stage may begin optional work within its budget.
    fn has_budget(&mut self, stage: Stage) -> bool {
        let _ = stage;
        true
    }

    /// Returns the remaining budget of a stage, in simulations without derivatives; infinite without a
    /// budget.
    fn left(&self, stage: Stage) -> f64 {
        let _ = stage;
        f64::INFINITY
    }

    /// Simulates a batch and returns its observations in order, `None` for an experiment that failed.
    ///
    /// # Errors
    /// If no worker is left, or the user stops the run.
    fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> impl Future<Output = Result<Vec<Option<Observation>>, Self::Error>>;
}

/// Returns the curves of an observation for the channels of a record, in their order; `None` unless the
/// observation is complete.
pub fn channels(observation: &Observation, record: &Record) -> Option<Curves> {
    if observation.verdict != Verdict::Complete {
        return None;
    }
    let curve = |recorded: &Recorded| recorded.pick(observation.curves.get(recorded.curve)?);
    record.channels.iter().map(curve).collect()
}

/// Simulates a batch of experiments on a record; returns the curves of its channels, `None` for an experiment
/// that failed.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn curves<L: Laboratory>(
    lab: &mut L,
    stage: Stage,
    record: &Record,
    batch: Vec<SimulateSpec>,
) -> Result<Vec<Option<Curves>>, L::Error> {
    let observed = lab.observe(stage, batch).await?;
    let own = |seen: Option<Observation>| channels(&seen?, record);
    Ok(observed.into_iter().map(own).collect())
}
