//! The numbers that decide who counts as lost, and how often what is tried again.
use protocol::job::Failure;
use std::{collections::VecDeque, time::Duration};

/// Times and limits; the defaults are measured to give no false loss on a machine with thirty
/// times more runnable threads than cores.
#[derive(Clone, Debug, PartialEq)]
pub struct Policy {
    /// A worker that is not heard for so long is lost (default 4 s; it speaks each second).
    pub silence: Duration,
    /// A job that a worker does not mention is sent again after so long (default 2 s).
    pub unmentioned: Duration,
    /// If the core is not called for so long, it stood still itself (default 1 s).
    pub stall: Duration,
    /// Jobs may wait so long without any worker before people are told (default 10 s).
    pub lonely: Duration,
    /// A waiting job may be taken from a busy worker for an idle one after so long (default
    /// 50 ms): less would only move short jobs about.
    pub steal_after: Duration,
    /// Jobs a worker holds per slot: one computes, one waits (default 2). More would queue bytes
    /// towards a worker that may freeze.
    pub per_slot: usize,
    /// Deadline while fewer than [`Self::deadline_samples`] jobs are done (default 120 s).
    pub first_deadline: Duration,
    /// Least deadline (default 10 s).
    pub least_deadline: Duration,
    /// Deadline over the median time of recent jobs (default 5).
    pub deadline_factor: u32,
    /// Jobs that make a median (default 5).
    pub deadline_samples: usize,
    /// Overdue attempts before a job is given up (default 2; each has twice the time).
    pub deadlines: u32,
    /// Crashed attempts before a job is given up (default 2): a slot that crashes ran nothing
    /// else, so the job is to blame.
    pub crashes: u32,
    /// Lost workers before a job runs alone (default 2): until then it may be bad company.
    pub suspect: u32,
    /// Lost workers before a job is given up (default 4).
    pub losses: u32,
    /// Failed jobs without any success before the run stops (default 8).
    pub hopeless: u32,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            silence: Duration::from_secs(4),
            unmentioned: Duration::from_secs(2),
            stall: Duration::from_secs(1),
            lonely: Duration::from_secs(10),
            steal_after: Duration::from_millis(50),
            per_slot: 2,
            first_deadline: Duration::from_mins(2),
            least_deadline: Duration::from_secs(10),
            deadline_factor: 5,
            deadline_samples: 5,
            deadlines: 2,
            crashes: 2,
            suspect: 2,
            losses: 4,
            hopeless: 8,
        }
    }
}

/// How often a job has failed, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Failures {
    /// Overdue attempts.
    pub(super) deadlines: u32,
    /// Crashed attempts.
    pub(super) crashes: u32,
    /// Workers lost over it.
    pub(super) losses: u32,
}

impl Failures {
    /// Counts a failure; `true` if the job is to be tried again.
    pub(super) fn count(&mut self, failure: &Failure, policy: &Policy) -> bool {
        match failure {
            Failure::Deadline { .. } => {
                self.deadlines += 1;
                self.deadlines < policy.deadlines
            }
            Failure::Crashed { .. } => {
                self.crashes += 1;
                self.crashes < policy.crashes
            }
            Failure::Lost { .. } => {
                self.losses += 1;
                self.losses < policy.losses
            }
            Failure::Refused { .. } => true,
            Failure::Misconfigured { .. } => false,
        }
    }
}

/// Times of recent jobs, for deadlines.
#[derive(Clone, Debug, Default)]
pub(super) struct Times {
    recent: VecDeque<u64>,
    median: Option<Duration>,
    since: usize,
}

impl Times {
    const KEPT: usize = 101;
    const RENEW: usize = 8;

    /// A job took so long.
    pub(super) fn add(&mut self, wall_us: u64, policy: &Policy) {
        if self.recent.len() == Self::KEPT {
            self.recent.pop_front();
        }
        self.recent.push_back(wall_us);
        self.since += 1;
        let enough = self.recent.len() >= policy.deadline_samples;
        if enough && (self.median.is_none() || self.since >= Self::RENEW) {
            let mut sorted: Vec<u64> = self.recent.iter().copied().collect();
            sorted.sort_unstable();
            self.median = sorted
                .get(sorted.len() / 2)
                .map(|us| Duration::from_micros(*us));
            self.since = 0;
        }
    }

    /// Time for the next attempt of a job that was overdue `overdue` times.
    pub(super) fn deadline(&self, overdue: u32, policy: &Policy) -> Duration {
        let once = self.median.map_or(policy.first_deadline, |median| {
            (median * policy.deadline_factor).max(policy.least_deadline)
        });
        once * 2_u32.saturating_pow(overdue.min(8))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deadlines_follow_the_median_not_the_mean() {
        let policy = Policy::default();
        let mut times = Times::default();
        assert_eq!(times.deadline(0, &policy), Duration::from_mins(2));
        for seconds in [7, 8, 9, 900, 8] {
            times.add(seconds * 1_000_000, &policy);
        }
        assert_eq!(times.deadline(0, &policy), Duration::from_secs(40));
        assert_eq!(times.deadline(1, &policy), Duration::from_secs(80));
        for _ in 0..200 {
            times.add(1_000, &policy);
        }
        assert_eq!(times.deadline(0, &policy), Duration::from_secs(10));
    }
}
