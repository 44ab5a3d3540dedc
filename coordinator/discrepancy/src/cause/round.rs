//! One round of suspicion, and what its tests and refits say together.
use crate::cause::refit::Refitted;
use crate::cause::suspect::Suspect;
use crate::linear::score::{chi_squared_tail, family_wise};
use crate::model::fit::Fit;

/// One round of suspicion.
#[derive(Clone, Debug)]
pub struct Round {
    /// Every named effect with its test, in the library's order.
    pub suspects: Vec<Suspect>,
    /// Forces without a cause, likewise.
    pub generics: Vec<Suspect>,
    /// Refits, the best first.
    pub refits: Vec<Refitted>,
    /// Log evidence without a further effect.
    pub null_evidence: f64,
    /// Dispersion of the best model, by which statistics and differences of log evidences are divided.
    pub dispersion: f64,
    /// Family-wise p-value of the named effects.
    pub p_value: f64,
    /// Identifiers that the record does not tell apart, the best first; empty if nothing was found.
    pub set: Vec<String>,
    /// Which effect was added, if any.
    pub added: Option<String>,
    /// How many names were ranked by what they predict where that gave the place of the added one to another; else 1.
    pub ranked: usize,
    /// Whether the added effect is one of several that were found together.
    pub together: bool,
    /// Why none was.
    pub reason: Option<String>,
}

impl Round {
    /// What all was tested and refitted, judged beside the model that it is added to.
    pub(crate) fn new(
        current: &Fit,
        suspects: Vec<Suspect>,
        generics: Vec<Suspect>,
        refits: Vec<Refitted>,
    ) -> Self {
        let mut round = Self {
            suspects,
            generics,
            refits,
            null_evidence: current.log_evidence(),
            dispersion: 1.0,
            p_value: 1.0,
            set: Vec::new(),
            added: None,
            ranked: 1,
            together: false,
            reason: None,
        };
        round.judge(current);
        round
    }

    /// A log evidence against the model without a further effect, over the dispersion (nats).
    pub fn nats(&self, log_evidence: f64) -> f64 {
        (log_evidence - self.null_evidence) / self.dispersion
    }

    /// Takes back what was added, for a reason.
    pub(crate) fn withdraw(&mut self, reason: String) {
        self.added = None;
        self.set.clear();
        self.reason = Some(reason);
    }

    /// Ranks the refits, and derives the dispersion of the best and the family's p-value under it.
    pub(crate) fn judge(&mut self, current: &Fit) {
        self.refits
            .sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        let best = self.refits.first().map(|own| own.fit.dispersion());
        self.dispersion = best
            .map_or(f64::INFINITY, |own| own)
            .min(current.dispersion());
        let scale = self.dispersion;
        let least = self
            .suspects
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
        self.p_value = family_wise(least, self.suspects.len().max(1));
    }
}
