//! Statistics of job durations by kind, and the deadlines, prefetching and copying derived from them.
use super::policy::Policy;
use protocol::job::kind::OWN;
use std::{
    collections::{BTreeMap, VecDeque},
    time::Duration,
};
use support::quantile;

/// Durations of finished jobs, by kind: the reduction of a horse head takes minutes, a simulation tenths of a
/// second.
#[derive(Clone, Debug, Default)]
pub(super) struct JobDurations(BTreeMap<&'static str, KindStats>);

#[derive(Clone, Debug, Default)]
struct KindStats {
    recent: VecDeque<u64>,
    longest: Duration,
    /// 95th percentile of the duration of recent jobs.
    percentile_95: Option<Duration>,
    /// Number of jobs of one kind finished since their 95th percentile was last computed.
    since: usize,
}

impl JobDurations {
    /// Number of recent jobs kept per kind.
    const KEPT: usize = 101;
    /// Number of finished jobs of a kind after which the 95th percentile of their durations is computed
    /// again.
    const RENEW: usize = 8;
    /// Percentile of the durations of recent jobs from which deadlines and copies are derived \[percent\].
    const USUAL: usize = 95;

    /// Adds the duration of a finished job to the statistics of its kind.
    pub(super) fn add(&mut self, kind: &'static str, wall_us: u64, policy: &Policy) {
        let kind = self.0.entry(kind).or_default();
        if kind.recent.len() == Self::KEPT {
            kind.recent.pop_front();
        }
        kind.recent.push_back(wall_us);
        kind.longest = kind.longest.max(Duration::from_micros(wall_us));
        kind.since += 1;
        let enough = kind.recent.len() >= policy.deadline_samples;
        if enough && (kind.percentile_95.is_none() || kind.since >= Self::RENEW) {
            let mut sorted: Vec<u64> = kind.recent.iter().copied().collect();
            sorted.sort_unstable();
            kind.percentile_95 = quantile::of(&sorted, Self::USUAL).map(Duration::from_micros);
            kind.since = 0;
        }
    }

    /// Returns the deadline of the next attempt at a job whose earlier attempts exceeded their deadline
    /// `overdue` times.
    pub(super) fn deadline(&self, kind: &'static str, overdue: u32, policy: &Policy) -> Duration {
        let known = self.0.get(kind);
        let usual = known.and_then(|kind| kind.percentile_95.map(|usual| (usual, kind.longest)));
        let first = match kind {
            OWN => policy.reduction_deadline,
            _ => policy.first_deadline,
        };
        let once = usual.map_or(first, |(usual, longest)| {
            usual
                .saturating_mul(policy.deadline_factor)
                .max(longest.saturating_mul(policy.longest_time_factor))
                .max(policy.least_deadline)
        });
        once.saturating_mul(2_u32.saturating_pow(overdue.min(8)))
    }

    /// Returns whether a slot needs its next order in advance, because waiting for it would take too large a
    /// share of the time; `latency` is the time from a result to the start of the next job. True while
    /// durations are unknown.
    pub(super) fn needs_prefetch(
        &self,
        kind: &'static str,
        latency: Option<Duration>,
        policy: &Policy,
    ) -> bool {
        let usual = self.0.get(kind).and_then(|kind| kind.percentile_95);
        let known = usual.zip(latency);
        known.is_none_or(|(usual, latency)| {
            latency.saturating_mul(100) > usual.saturating_mul(policy.prefetch_percent)
        })
    }

    /// Returns the running time after which an idle slot may take a copy of a job; `None` while durations are
    /// unknown.
    pub(super) fn copy_after(&self, kind: &'static str, policy: &Policy) -> Option<Duration> {
        let usual = self.0.get(kind)?.percentile_95?;
        Some((usual.saturating_mul(policy.copy_after_percent) / 100).max(policy.least_copy_after))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(seconds: impl IntoIterator<Item = u64>) -> JobDurations {
        let mut times = JobDurations::default();
        for seconds in seconds {
            times.add("score", seconds * 1_000_000, &Policy::default());
        }
        times
    }

    #[test]
    fn a_deadline_follows_the_quantile_of_its_own_kind() {
        let policy = Policy::default();
        let none = JobDurations::default();
        assert_eq!(none.deadline("score", 0, &policy), Duration::from_mins(2));
        let times = after([7, 8, 9, 10, 8]);
        assert_eq!(times.deadline("score", 0, &policy), Duration::from_secs(40));
        assert_eq!(times.deadline("score", 1, &policy), Duration::from_secs(80));
        assert_eq!(
            times.deadline("score", 2, &policy),
            Duration::from_secs(160)
        );
        assert_eq!(
            times.deadline("simulate", 0, &policy),
            Duration::from_mins(2),
            "nothing is known of that kind"
        );
        assert_eq!(
            times.deadline(OWN, 0, &policy),
            Duration::from_mins(30),
            "a fine mesh takes long on a busy node"
        );
    }

    /// Checks that many short failed runs do not shorten the deadline so far that good runs become overdue.
    #[test]
    fn many_short_failures_do_not_shorten_the_deadline_of_good_runs() {
        let policy = Policy::default();
        let times = after((0..100).map(|n| if n % 10 == 0 { 30 } else { 1 }));
        assert_eq!(times.deadline("score", 0, &policy), Duration::from_mins(2));
        // only one in fifty works: the longest that ever did still has time
        let times = after((0..100).map(|n| if n == 7 { 30 } else { 1 }));
        assert_eq!(times.deadline("score", 0, &policy), Duration::from_mins(1));
    }

    #[test]
    fn no_deadline_is_below_the_least_and_a_liar_cannot_overflow_it() {
        let policy = Policy::default();
        let times = after([0; 50]);
        assert_eq!(times.deadline("score", 0, &policy), policy.least_deadline);
        assert_eq!(
            times.copy_after("score", &policy),
            Some(policy.least_copy_after)
        );
        let mut times = JobDurations::default();
        for _ in 0..9 {
            times.add("score", u64::MAX, &policy);
        }
        assert!(times.deadline("score", 8, &policy) > Duration::from_hours(1000));
    }
}
