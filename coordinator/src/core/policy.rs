//! The numbers that decide who counts as lost, and how often what is tried again.
//!
//! | what went wrong | tried again | until | then |
//! |---|---|---|---|
//! | the physics (a verdict) | never | | it is the job's result |
//! | deadline | with twice the time | 2 attempts | a failed result, recorded |
//! | crashed | on any worker | 2 attempts | a failed result, recorded |
//! | its worker was lost | on any worker; alone on one after 2 | 4 workers | a failed result, recorded |
//! | refused | on workers that have not refused | all have | handed on, not recorded |
//! | misconfigured | never | | handed on, not recorded |
//!
//! What is recorded is part of the run and never computed again; another build or another case may
//! do better with the last two. If the first 8 jobs all fail, the run stops.
use protocol::job::{Failure, kind::REDUCE_HEAD};
use std::{
    collections::{BTreeMap, VecDeque},
    time::Duration,
};

/// Times and limits; the defaults are measured to give no false loss on a machine with thirty
/// times more runnable threads than cores.
#[derive(Clone, Debug, PartialEq)]
pub struct Policy {
    /// A worker that is not heard for so long is lost (default 4 s; it speaks each second).
    pub silence: Duration,
    /// A job that a worker does not mention is sent again after so long (default 2 s).
    pub unmentioned: Duration,
    /// A process that goes on with a run waits so long for workers that outlived the last one before
    /// it gives out what they may hold (default 3 s: they try to connect every 2 s).
    pub reunion: Duration,
    /// After the last of them came back, it waits so long for the results they bring (default
    /// 500 ms).
    pub delivery: Duration,
    /// If the core is not called for so long, it stood still itself (default 1 s).
    pub stall: Duration,
    /// If it stood still for so long, workers may have given up their connections to it (default 2 s:
    /// they do after 3 s without a word).
    pub estranged: Duration,
    /// They may take so long to come back before their silence counts (default 3 s: they try to
    /// connect every 2 s).
    pub return_within: Duration,
    /// Jobs may wait so long without any worker before people are told (default 10 s).
    pub lonely: Duration,
    /// A waiting job may be taken from a busy worker for an idle one after so long (default
    /// 50 ms): less would only move short jobs about.
    pub steal_after: Duration,
    /// Jobs a worker holds per slot at most: one computes, one waits (default 2). More would queue
    /// bytes towards a worker that may freeze.
    pub per_slot: usize,
    /// A second job is sent ahead only if without it a slot would spend more than this share of its
    /// time waiting for the next order, in percent (default 4). Where jobs are long, what waits
    /// behind a slow one would hold up a search that needs results in order.
    pub prefetch_percent: u32,
    /// Results on their way to the disk beyond which nothing is given out (default 1024): memory is
    /// not there to hold what a slow disk does not take.
    pub unstored: usize,
    /// Deadline while fewer than [`Self::deadline_samples`] jobs are done (default 120 s).
    pub first_deadline: Duration,
    /// The same for the reduction of a head, which is asked for once and takes as long as its mesh is
    /// large (default 30 min).
    pub reduction_deadline: Duration,
    /// Least deadline (default 10 s).
    pub least_deadline: Duration,
    /// Deadline over the time that 95 % of recent jobs of the kind needed (default 4).
    pub deadline_factor: u32,
    /// Deadline over the longest time that any job of the kind needed in this process (default 2):
    /// what has worked once must not come as a surprise.
    pub longest_factor: u32,
    /// Finished jobs of a kind before anything is concluded from their times (default 5).
    pub deadline_samples: usize,
    /// When nothing is left to give out, an idle slot takes a copy of a job that has been computed
    /// for this many times as long as 95 % of recent ones needed, in percent (default 150).
    pub copy_percent: u32,
    /// No copy is made of a job that has been computed for less (default 200 ms).
    pub copy_least: Duration,
    /// Overdue attempts before a job is given up (default 2; each has twice the time).
    pub deadlines: u32,
    /// Crashed attempts before a job is given up (default 2): a slot that crashes ran nothing
    /// else, so the job is to blame.
    pub crashes: u32,
    /// Lost workers that held a job, computing it or not, before it runs alone (default 2): until
    /// then it may be bad company.
    pub suspect: u32,
    /// Lost workers that held a job before it is given up (default 4): on the last two of them there
    /// was nothing else.
    pub losses: u32,
    /// Time between two accounts of slot time in the journal (default 60 s).
    pub account: Duration,
    /// Failed jobs without any success before the run stops (default 8).
    pub hopeless: u32,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            silence: Duration::from_secs(4),
            unmentioned: Duration::from_secs(2),
            reunion: Duration::from_secs(3),
            delivery: Duration::from_millis(500),
            stall: Duration::from_secs(1),
            estranged: Duration::from_secs(2),
            return_within: Duration::from_secs(3),
            lonely: Duration::from_secs(10),
            steal_after: Duration::from_millis(50),
            per_slot: 2,
            prefetch_percent: 4,
            unstored: 1024,
            first_deadline: Duration::from_mins(2),
            reduction_deadline: Duration::from_mins(30),
            least_deadline: Duration::from_secs(10),
            deadline_factor: 4,
            longest_factor: 2,
            deadline_samples: 5,
            copy_percent: 150,
            copy_least: Duration::from_millis(200),
            deadlines: 2,
            crashes: 2,
            suspect: 2,
            losses: 4,
            account: Duration::from_mins(1),
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

/// Times of finished jobs by kind, for deadlines and copies: a reduction of a head takes minutes
/// where a simulation takes tenths of a second.
#[derive(Clone, Debug, Default)]
pub(super) struct Times(BTreeMap<&'static str, Kind>);

#[derive(Clone, Debug, Default)]
struct Kind {
    recent: VecDeque<u64>,
    longest: Duration,
    /// What 95 % of the recent jobs needed at most.
    usual: Option<Duration>,
    since: usize,
}

impl Times {
    const KEPT: usize = 101;
    const RENEW: usize = 8;
    /// Least share of recent jobs that needed no more than the usual time [percent].
    const USUAL: usize = 95;

    /// A job took so long.
    pub(super) fn add(&mut self, kind: &'static str, wall_us: u64, policy: &Policy) {
        let kind = self.0.entry(kind).or_default();
        if kind.recent.len() == Self::KEPT {
            kind.recent.pop_front();
        }
        kind.recent.push_back(wall_us);
        kind.longest = kind.longest.max(Duration::from_micros(wall_us));
        kind.since += 1;
        let enough = kind.recent.len() >= policy.deadline_samples;
        if enough && (kind.usual.is_none() || kind.since >= Self::RENEW) {
            let mut sorted: Vec<u64> = kind.recent.iter().copied().collect();
            sorted.sort_unstable();
            let at = (sorted.len() * Self::USUAL).div_ceil(100).saturating_sub(1);
            kind.usual = sorted.get(at).map(|us| Duration::from_micros(*us));
            kind.since = 0;
        }
    }

    /// Time for the next attempt of a job that was overdue `overdue` times.
    pub(super) fn deadline(&self, kind: &'static str, overdue: u32, policy: &Policy) -> Duration {
        let known = self.0.get(kind);
        let usual = known.and_then(|kind| kind.usual.map(|usual| (usual, kind.longest)));
        let first = match kind {
            REDUCE_HEAD => policy.reduction_deadline,
            _ => policy.first_deadline,
        };
        let once = usual.map_or(first, |(usual, longest)| {
            usual
                .saturating_mul(policy.deadline_factor)
                .max(longest.saturating_mul(policy.longest_factor))
                .max(policy.least_deadline)
        });
        once.saturating_mul(2_u32.saturating_pow(overdue.min(8)))
    }

    /// Whether a slot would wait too long for its next order if it did not have it already, `latency`
    /// being the time from a result to the next job's beginning; until something is known, it would.
    pub(super) fn needs_prefetch(
        &self,
        kind: &'static str,
        latency: Option<Duration>,
        policy: &Policy,
    ) -> bool {
        let usual = self.0.get(kind).and_then(|kind| kind.usual);
        let known = usual.zip(latency);
        known.is_none_or(|(usual, latency)| {
            latency.saturating_mul(100) > usual.saturating_mul(policy.prefetch_percent)
        })
    }

    /// How long a job must have been computed before an idle slot may take a copy of it; none
    /// before anything is known.
    pub(super) fn copy_after(&self, kind: &'static str, policy: &Policy) -> Option<Duration> {
        let usual = self.0.get(kind)?.usual?;
        Some((usual.saturating_mul(policy.copy_percent) / 100).max(policy.copy_least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(seconds: impl IntoIterator<Item = u64>) -> Times {
        let mut times = Times::default();
        for seconds in seconds {
            times.add("score", seconds * 1_000_000, &Policy::default());
        }
        times
    }

    #[test]
    fn a_deadline_follows_the_quantile_of_its_own_kind() {
        let policy = Policy::default();
        let none = Times::default();
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
            times.deadline(REDUCE_HEAD, 0, &policy),
            Duration::from_mins(30),
            "a fine mesh takes long on a busy node"
        );
    }

    /// Most runs fail early and are short: those that work must not be taken for overdue.
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
        assert_eq!(times.copy_after("score", &policy), Some(policy.copy_least));
        let mut times = Times::default();
        for _ in 0..9 {
            times.add("score", u64::MAX, &policy);
        }
        assert!(times.deadline("score", 8, &policy) > Duration::from_hours(1000));
    }
}
