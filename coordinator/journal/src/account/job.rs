//! Statistics of a run's jobs by kind, with their durations, and the jobs that were given up with the
//! reasons.
use crate::event::Finished;
use protocol::job::{Outcome, Verdict};
use std::collections::BTreeMap;
use support::quantile;

/// Statistics of the results of one kind of job.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobUse {
    /// Number of results of jobs of this kind.
    pub results: u64,
    /// Number of results in which the simulated machine failed before completion.
    pub machine_failed: u64,
    /// Median wall-clock time of a job of this kind in its worker slot \[s\].
    pub median_s: f64,
    /// 95 % quantile of the wall-clock time of a job of this kind in its worker slot \[s\].
    pub usual_s: f64,
    /// Longest wall-clock time of a job of this kind in its worker slot \[s\].
    pub longest_s: f64,
    /// Total wall-clock time of the jobs of this kind in their worker slots \[s\].
    pub wall_s: f64,
    /// Total processor time of the jobs of this kind \[s\].
    pub processor_s: f64,
}

/// Accumulator of the statistics of a run's jobs.
#[derive(Clone, Debug, Default)]
pub(super) struct Jobs {
    kinds: BTreeMap<&'static str, Kind>,
    given_up: Vec<(u64, String)>,
}

#[derive(Clone, Debug, Default)]
struct Kind {
    times_us: Vec<u64>,
    cpu_us: u64,
    machine_failed: u64,
}

impl Jobs {
    pub(super) fn add(&mut self, finished: &Finished) {
        let outcome = &finished.outcome;
        if let Outcome::Failed(failure) = outcome {
            self.given_up.push((finished.job().0, failure.to_string()));
            return;
        }
        let failed = matches!(outcome.simulation(), Some((Verdict::Failed { .. }, _)));
        let kind = self.kinds.entry(outcome.kind()).or_default();
        kind.times_us.push(finished.cost.wall_us);
        kind.cpu_us = kind.cpu_us.saturating_add(finished.cost.cpu_us);
        kind.machine_failed += u64::from(failed);
    }

    /// Returns the job statistics by kind of job, and the numbers of the jobs given up with the reason.
    pub(super) fn counted(self) -> (BTreeMap<&'static str, JobUse>, Vec<(u64, String)>) {
        let used = |(name, mut kind): (&'static str, Kind)| {
            kind.times_us.sort_unstable();
            let wall_s = |percent| {
                let us: Option<u64> = quantile::of(&kind.times_us, percent);
                us.map_or(0.0, |us| us as f64 / 1e6)
            };
            let used = JobUse {
                results: kind.times_us.len() as u64,
                machine_failed: kind.machine_failed,
                median_s: wall_s(50),
                usual_s: wall_s(95),
                longest_s: wall_s(100),
                wall_s: kind.times_us.iter().map(|us| *us as f64 / 1e6).sum(),
                processor_s: kind.cpu_us as f64 / 1e6,
            };
            (name, used)
        };
        (self.kinds.into_iter().map(used).collect(), self.given_up)
    }
}
