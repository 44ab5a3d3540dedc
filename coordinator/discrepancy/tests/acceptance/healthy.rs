//! Diagnoses of healthy machines, cached. Every planted size is a multiple of the detection limits of such a
//! diagnosis, so several test groups need the same one.
use crate::trial::{diagnose_usual, line};
use crate::truth::Truth;
use discrepancy::diagnose::Limit;
use discrepancy::localisation::parameter_drift::ParameterDrift;
use discrepancy::verdict::Verdict;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Results of the diagnosis of a healthy machine.
pub(crate) struct Healthy {
    /// Detection limits of all effects on the healthy machine.
    pub(crate) limits: Vec<Limit>,
    pub(crate) verdict: Verdict,
    pub(crate) wander: Vec<ParameterDrift>,
    pub(crate) line: String,
}

type Known = BTreeMap<(u64, u64), Arc<OnceLock<Arc<Healthy>>>>;

/// Cached diagnoses, by seed and bits of the noise factor.
static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());

/// Returns the diagnosis of the healthy machine of a seed, measured with `noise` times the usual noise.
pub(crate) fn healthy(seed: u64, noise: f64) -> Arc<Healthy> {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let place = Arc::clone(known.entry((seed, noise.to_bits())).or_default());
    // others need not wait for this one unless they want the same
    drop(known);
    let made = place.get_or_init(|| {
        let answer = diagnose_usual(&Truth::healthy(seed).noisy(noise));
        Arc::new(Healthy {
            verdict: answer.verdict,
            line: line(&answer),
            limits: answer.limits,
            wander: answer.drifts,
        })
    });
    Arc::clone(made)
}
