//! What the jobs of a run were and how long they took, by kind; which were given up and why.
use protocol::{
    event::Finished,
    job::{Outcome, Verdict},
};
use std::collections::BTreeMap;

/// The results of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobUse {
    /// How many.
    pub results: u64,
    /// How many of them say that the machine failed on the way.
    pub machine_failed: u64,
    /// Time in the slot that half of them needed at most \[s\].
    pub median_s: f64,
    /// What 95 % of them needed at most \[s\].
    pub usual_s: f64,
    /// What the longest needed \[s\].
    pub longest_s: f64,
}

/// Results while they are counted.
#[derive(Debug, Default)]
pub(super) struct Jobs {
    kinds: BTreeMap<&'static str, Kind>,
    given_up: Vec<(u64, String)>,
}

#[derive(Debug, Default)]
struct Kind {
    times_us: Vec<u64>,
    machine_failed: u64,
}

impl Jobs {
    pub(super) fn add(&mut self, finished: &Finished) {
        let outcome = &finished.outcome;
        if let Outcome::Failed(failure) = outcome {
            self.given_up.push((finished.job().0, failure.to_string()));
            return;
        }
        let failed = matches!(outcome.verdict(), Some(Verdict::Failed { .. }));
        let kind = self.kinds.entry(outcome.kind()).or_default();
        kind.times_us.push(finished.wall_us);
        kind.machine_failed += u64::from(failed);
    }

    /// By kind, and the jobs that were given up with the reason.
    pub(super) fn counted(self) -> (BTreeMap<&'static str, JobUse>, Vec<(u64, String)>) {
        let used = |(name, mut kind): (&'static str, Kind)| {
            kind.times_us.sort_unstable();
            let quantile = |percent: usize| {
                let at = (kind.times_us.len() * percent).div_ceil(100).max(1) - 1;
                kind.times_us.get(at).map_or(0.0, |us| *us as f64 / 1e6)
            };
            let used = JobUse {
                results: kind.times_us.len() as u64,
                machine_failed: kind.machine_failed,
                median_s: quantile(50),
                usual_s: quantile(95),
                longest_s: quantile(100),
            };
            (name, used)
        };
        (self.kinds.into_iter().map(used).collect(), self.given_up)
    }
}
