//! Round of hypothesis tests: tests and refits of all candidate effects on one model, and the decision drawn
//! from them.
use crate::hypothesis::candidate::{CandidateEffect, WorkingCandidate};
use crate::hypothesis::refit::Refitted;
use crate::linear::score::{chi_squared_tail, family_wise};
use crate::model::fit::{Fit, FitSummary};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Round with its fits and signatures, as later steps of the diagnosis need it.
pub(crate) type WorkingRound = Round<Fit, DMatrix<f64>>;

/// Round of hypothesis tests in a diagnosis: tests of all candidate effects, refits of the likeliest, and the
/// decision.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Round<F = FitSummary, S = f64> {
    /// Tests of all named effects, in the library's order.
    pub candidates: Vec<CandidateEffect<S>>,
    /// Tests of the generic forces, with which the named effects are compared.
    pub generics: Vec<CandidateEffect<S>>,
    /// Refits of the likeliest candidate effects, in descending order of their log evidence.
    pub refits: Vec<Refitted<F>>,
    /// Log evidence of the current model, without a further effect.
    pub null_evidence: f64,
    /// Dispersion of the best model, by which differences of log evidences are divided.
    pub dispersion: f64,
    /// Misfit (`chi^2` per degree of freedom) of the best model, by which the statistics of tests are divided.
    pub misfit: f64,
    /// Family-wise p-value of the tests of all named effects.
    pub p_value: f64,
    /// Ambiguity set: identifiers of the effects that the record cannot distinguish from the added one, best
    /// first; empty if no effect was added.
    pub set: Vec<String>,
    /// Identifier of the effect that the round added, if any.
    pub added: Option<String>,
    /// Identifier of the likeliest effect if it is no more than a trace.
    pub trace: Option<String>,
    /// Number of effects ranked by evidence and prediction when the ranking replaced the effect that was
    /// added first; 1 if it was not replaced.
    pub ranked: usize,
    /// Whether the added effect is one of several that were found together.
    pub together: bool,
    /// Reason why the round added no effect.
    pub reason: Option<String>,
}

impl<F, S> Round<F, S> {
    /// Returns a log evidence relative to the current model, divided by the dispersion (nats).
    pub fn nats(&self, log_evidence: f64) -> f64 {
        (log_evidence - self.null_evidence) / self.dispersion
    }
}

impl WorkingRound {
    /// Creates a round from its tests and refits, and ranks the refits relative to the current model.
    pub(crate) fn new(
        current: &Fit,
        suspects: Vec<WorkingCandidate>,
        generics: Vec<WorkingCandidate>,
        refits: Vec<Refitted<Fit>>,
    ) -> Self {
        let mut round = Self {
            candidates: suspects,
            generics,
            refits,
            null_evidence: current.log_evidence(),
            dispersion: 1.0,
            misfit: 1.0,
            p_value: 1.0,
            set: Vec::new(),
            added: None,
            trace: None,
            ranked: 1,
            together: false,
            reason: None,
        };
        round.judge(current);
        round
    }

    /// Returns the round as reports read it: with summaries of its fits and signatures.
    pub(crate) fn summary(self) -> Round {
        let tests = |all: Vec<WorkingCandidate>| all.into_iter().map(WorkingCandidate::summary);
        let refits = self.refits.into_iter().map(|own| Refitted {
            id: own.id,
            fit: own.fit.summary(),
            log_evidence: own.log_evidence,
        });
        Round {
            candidates: tests(self.candidates).collect(),
            generics: tests(self.generics).collect(),
            refits: refits.collect(),
            null_evidence: self.null_evidence,
            dispersion: self.dispersion,
            misfit: self.misfit,
            p_value: self.p_value,
            set: self.set,
            added: self.added,
            trace: self.trace,
            ranked: self.ranked,
            together: self.together,
            reason: self.reason,
        }
    }

    /// Returns the fit with the likeliest effect if that is no more than a trace.
    pub(crate) fn traced(&self) -> Option<&Fit> {
        let id = self.trace.as_ref()?;
        let mut refits = self.refits.iter();
        refits.find(|own| own.id == *id).map(|own| &own.fit)
    }

    /// Withdraws the effect that the round added, and records the reason.
    pub(crate) fn withdraw(&mut self, reason: String) {
        self.added = None;
        self.set.clear();
        self.reason = Some(reason);
    }

    fn sort(&mut self) {
        self.refits
            .sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    }

    /// Ranks the refits by evidence, averaged over the discrepancies that the likeliest and the current model
    /// need, and derives dispersion and misfit of the best model and the family-wise p-value under it.
    pub(crate) fn judge(&mut self, current: &Fit) {
        /// Number of rankings: the likeliest may be another one under the discrepancy that the first needs.
        const RANKINGS: usize = 2;
        for refit in &mut self.refits {
            refit.log_evidence = refit.fit.log_evidence_of_noise();
        }
        for _ in 0..RANKINGS {
            self.sort();
            let leader = self.refits.first().map_or(current, |own| &own.fit);
            let among = leader.discrepancies(current);
            self.null_evidence = current.log_evidence_among(&among);
            for refit in &mut self.refits {
                refit.log_evidence = refit.fit.log_evidence_among(&among);
            }
        }
        self.sort();
        let best = self.refits.first().map_or(current, |own| &own.fit);
        self.dispersion = best.dispersion().min(current.dispersion());
        self.misfit = best.misfit().min(current.misfit());
        let scale = self.misfit;
        let least = self
            .candidates
            .iter()
            .filter_map(|s| Some((s.score.as_ref()?, s.tries)))
            .map(|(score, tries)| {
                let tail = chi_squared_tail(score.statistic / scale, score.freedom);
                // an estimate of the wrong sign speaks against its effect
                let own = if score.p_value < 1.0 { tail } else { 1.0 };
                family_wise(own, tries)
            })
            .fold(1.0, f64::min);
        // no test at all rejects nothing
        self.p_value = family_wise(least, self.candidates.len().max(1));
    }
}
