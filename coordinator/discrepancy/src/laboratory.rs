//! Where experiments are done: whoever simulates batches of points.
use crate::record::measured::{Curves, Record, Recorded};
use protocol::job::{Observation, SimulateSpec, Verdict};

/// A part of the diagnosis, for progress and for accounts of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// A way into the valley in which resonances fit.
    Basin,
    /// Fit of all unknowns in the metric of the tests.
    Recalibrate,
    /// How much the discretisation matters.
    Preflight,
    /// Maps of the disagreement.
    Where,
    /// Signatures and tests of all effects.
    What,
    /// Refits of the suspects.
    Refit,
    /// The gap before and after.
    Show,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 7] = [
        Self::Basin,
        Self::Recalibrate,
        Self::Preflight,
        Self::Where,
        Self::What,
        Self::Refit,
        Self::Show,
    ];

    /// In a word or two.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Basin => "way into the valley",
            Self::Recalibrate => "recalibration",
            Self::Preflight => "numerical check",
            Self::Where => "where",
            Self::What => "what",
            Self::Refit => "refits",
            Self::Show => "show",
        }
    }
}

/// Whoever simulates experiments.
pub trait Laboratory {
    /// Why no experiment can be done any more.
    type Error;

    /// Whether observations come with the columns that a job asks for, or with a reason why not; where it
    /// says no, differences of whole experiments do.
    fn differentiates(&self) -> bool {
        false
    }

    /// Whether a stage may begin something that it could do without.
    fn may(&mut self, stage: Stage) -> bool {
        let _ = stage;
        true
    }

    /// What a stage has left of its part, in plain simulations; infinite where nothing bounds it.
    fn left(&self, stage: Stage) -> f64 {
        let _ = stage;
        f64::INFINITY
    }

    /// Does a batch; observations in its order, nothing for an experiment that did not run to its
    /// end.
    ///
    /// # Errors
    /// If nobody can do experiments any more, or the user stops.
    fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> impl Future<Output = Result<Vec<Option<Observation>>, Self::Error>>;
}

/// The curves of an observation that a record has, in its order; nothing unless it is complete.
pub fn channels(observation: &Observation, record: &Record) -> Option<Curves> {
    if observation.verdict != Verdict::Complete {
        return None;
    }
    let curve = |recorded: &Recorded| recorded.pick(observation.curves.get(recorded.curve)?);
    record.channels.iter().map(curve).collect()
}

/// Does a batch of experiments on a record; the curves of its channels, nothing for an experiment that
/// failed.
///
/// # Errors
/// Those of the laboratory.
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
