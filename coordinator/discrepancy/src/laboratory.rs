//! Interface to the simulation of batches of points.
use protocol::job::{Observation, SimulateSpec, Verdict};
use record::{Curves, Record, Recorded};
use serde::{Deserialize, Serialize};

/// Stage of a diagnosis, for progress reports, timing and budgets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Stage {
    /// Global search for the narrow minimum in which resonances fit.
    Basin,
    /// Fit of all unknowns in the metric of the tests.
    Recalibrate,
    /// Numerical check: estimate of the discretisation error of the simulated curves.
    Preflight,
    /// Localisation of the residual: abscissa, orders and joints at which simulation and record disagree.
    Where,
    /// Signatures (first-order changes of the curves) and hypothesis tests of all candidate effects.
    Test,
    /// Refits of the model with the most likely candidate effects added.
    Refit,
    /// Validation: misfit before and after adding the effects.
    Show,
}

impl Stage {
    /// All stages of a diagnosis, in the order in which they run.
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

/// Interim result of a diagnosis, a function of the results so far: the suspects of the present model, and what it leaves of the record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Identifiers of the effects that the present model has in addition to the case's own.
    pub added: Vec<String>,
    /// Gap of the present model: mean squared residual above the noise over the variance of the measured curves
    /// \[1\].
    pub gap: f64,
    /// Candidate effects that were tested against the present model, likeliest first.
    pub suspects: Vec<Suspect>,
}

/// Candidate effect of an interim result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Suspect {
    /// Identifier of the effect.
    pub id: String,
    /// Title of the effect.
    pub title: String,
    /// p-value of the effect's own score test \[1\].
    pub p_value: f64,
    /// Log evidence gained by the model with the effect after a refit (nats); `None` before, or if it was not
    /// refitted.
    pub gain: Option<f64>,
}

/// Simulator of batches of experiments, through which a diagnosis obtains all simulated curves.
pub trait Laboratory {
    /// Error that ends the diagnosis because no further experiment can be simulated.
    type Error;

    /// Returns whether the laboratory computes derivatives that a job requests; if not, finite differences of
    /// whole experiments are used.
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

    /// Returns whether the result of an experiment is known, so that it costs no simulation.
    fn is_known(&self, spec: &SimulateSpec) -> bool {
        let _ = spec;
        false
    }

    /// Receives an interim result of the diagnosis, which has no influence on it.
    ///
    /// # Errors
    /// If the laboratory keeps interim results and cannot keep this one.
    fn found(&mut self, finding: &Finding) -> Result<(), Self::Error> {
        let _ = finding;
        Ok(())
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

/// Returns the simulated curves of an observation that belong to a record's channels, in the order of the
/// channels; `None` if the simulation did not complete.
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
