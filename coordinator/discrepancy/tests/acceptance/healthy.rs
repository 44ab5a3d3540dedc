//! Diagnoses of machines that nothing is wrong with. Every planted size is a multiple of the limits that
//! one of them prints, so that several strata ask for the same: each is made once.
use crate::trial::{diagnose_usual, line};
use crate::truth::Truth;
use discrepancy::diagnose::Limit;
use discrepancy::place::wander::Wander;
use discrepancy::verdict::Verdict;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What a diagnosis says about a healthy machine.
pub(crate) struct Healthy {
    /// What it would have seen.
    pub(crate) limits: Vec<Limit>,
    /// What it says.
    pub(crate) verdict: Verdict,
    /// Which parameters would have to wander.
    pub(crate) wander: Vec<Wander>,
    /// All in one line.
    pub(crate) line: String,
}

type Known = BTreeMap<(u64, u64), Arc<OnceLock<Arc<Healthy>>>>;

/// By seed and bits of the noise.
static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());

/// The diagnosis of the healthy machine of a seed, read with so many times the usual noise.
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
            wander: answer.wander,
        })
    });
    Arc::clone(made)
}
