//! Refits with a candidate effect switched on: every unknown and every parameter of the effect is free.
use crate::hypothesis::candidate::WorkingCandidate;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, FitSummary};
use crate::model::unknowns::Point;
use search::least_squares::LeastSquaresSettings;
use serde::{Deserialize, Serialize};

/// Maximum number of ladder sizes from which an effect is refitted, in addition to its linear estimate.
const STARTS: usize = 3;

/// Candidate effect after its refit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Refitted<F = FitSummary> {
    /// Identifier of the effect.
    pub id: String,
    /// Best fit with the effect.
    pub fit: F,
    /// Log evidence of the refitted model (nats): if all that it leaves were noise, until the round of tests is
    /// judged, then averaged over the discrepancies of the round.
    pub log_evidence: f64,
}

impl Refitted<Fit> {
    /// Creates the record of a candidate effect's refit from a fit whose last added effect is the candidate.
    pub(crate) fn new(id: String, fit: Fit) -> Self {
        Self {
            id,
            log_evidence: fit.log_evidence_of_noise(),
            fit,
        }
    }
}

/// Refits candidate effects in parallel, each from its linear estimate and from the best of a ladder of other
/// sizes, and returns the best refit of each; effects of which no refit can be simulated are omitted.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn refit<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    suspects: &[&WorkingCandidate],
) -> Result<Vec<Refitted<Fit>>, L::Error> {
    let starts = |suspect: &&WorkingCandidate| {
        let all = std::iter::once(&suspect.start).chain(suspect.rungs.iter().take(STARTS));
        let all = all.map(|start| (suspect.effect.id.clone(), fit.with(&suspect.effect, start)));
        all.collect::<Vec<(String, Point)>>()
    };
    let (ids, starts): (Vec<String>, Vec<Point>) = suspects.iter().flat_map(starts).unzip();
    let fits = experiments
        .fits(starts, LeastSquaresSettings::short(8))
        .await?;
    let mut refits: Vec<Refitted<Fit>> = Vec::new();
    for (id, fit) in ids.into_iter().zip(fits) {
        let Some(fit) = fit else { continue };
        let own = Refitted::new(id, fit);
        match refits.iter_mut().find(|other| other.id == own.id) {
            Some(other) if own.log_evidence > other.log_evidence => *other = own,
            Some(_) => {}
            None => refits.push(own),
        }
    }
    Ok(refits)
}
