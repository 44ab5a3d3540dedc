//! Refits with a candidate effect switched on: every unknown and every parameter of the effect is free.
use crate::hypothesis::candidate::WorkingCandidate;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, FitSummary};
use crate::model::unknowns::Point;
use search::least_squares::{LeastSquaresSettings, Termination};
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

/// Share of the best refit's gain of evidence below which a candidate effect is not pursued. On the shipped record the
/// shares of eight effects after one step and after eight iterations differ by at most 0.09.
const HOPEFUL: f64 = 0.25;
/// Distance from the best refit's gain of evidence (nats) within which a candidate effect is pursued whatever the
/// share.
const CLOSE: f64 = 20.0;
/// Iterations of every refit, which is one step, and of those that may compete with the best one afterwards.
const ITERATIONS: [u32; 2] = [2, 8];
/// Number of starts of one effect that are pursued after the first step.
const PURSUED: usize = 2;

/// Returns whether a candidate effect that gains this much evidence over the current model may compete with one
/// that gains `best` (nats).
pub(crate) fn may_compete(gain: f64, best: f64) -> bool {
    gain > HOPEFUL * best || best - gain < CLOSE
}

/// Refits candidate effects in parallel, each from its linear estimate and from the best of a ladder of other
/// sizes, and returns the best refit of each; effects of which no refit can be simulated are omitted. Refits
/// that cannot compete with the best one, or with a gain of `best` (nats) that another effect has, are left as they
/// are after the first step.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn refit<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    suspects: &[&WorkingCandidate],
    best: f64,
) -> Result<Vec<Refitted<Fit>>, L::Error> {
    let starts = |suspect: &&WorkingCandidate| {
        let all = std::iter::once(&suspect.start).chain(suspect.rungs.iter().take(STARTS));
        let all = all.map(|start| (suspect.effect.id.clone(), fit.with(&suspect.effect, start)));
        all.collect::<Vec<(String, Point)>>()
    };
    let (ids, starts): (Vec<String>, Vec<Point>) = suspects.iter().flat_map(starts).unzip();
    let [few, all] = ITERATIONS;
    let mut fits = experiments
        .fits(starts, LeastSquaresSettings::short(few))
        .await?;
    // what a fit has gained, and what its next step promises to
    let null = fit.log_evidence_of_noise();
    let gain = |fit: &Fit| {
        let promised = fit.search.predicted_decrease() * fit.search.cost();
        fit.log_evidence_of_noise() - null + 0.5 * promised
    };
    let best = fits.iter().flatten().map(gain).fold(best, f64::max);
    let mut order: Vec<usize> = (0..fits.len()).collect();
    let gains: Vec<f64> = fits
        .iter()
        .map(|fit| fit.as_ref().map_or(f64::NEG_INFINITY, gain))
        .collect();
    order.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
    let is_open = |at: &usize| {
        let better = order.iter().take_while(|other| *other != at);
        let own = better.filter(|other| ids[**other] == ids[*at]).count();
        let ended = fits[*at].as_ref().and_then(|fit| fit.search.ended());
        ended == Some(Termination::Iterations) && own < PURSUED && may_compete(gains[*at], best)
    };
    let open: Vec<usize> = (0..fits.len()).filter(is_open).collect();
    let starts = open.iter().filter_map(|at| fits[*at].as_ref());
    let starts = starts.map(Fit::point).collect();
    let further = experiments
        .fits(starts, LeastSquaresSettings::short(all - few))
        .await?;
    for (at, further) in open.into_iter().zip(further) {
        if further.is_some() {
            fits[at] = further;
        }
    }
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
