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
use protocol::case::{Case, Repeats};
use std::time::Duration;

/// Times and limits; the defaults are measured to give no false loss on a machine with thirty
/// times more runnable threads than cores.
#[derive(Clone, Debug, PartialEq)]
pub struct Policy {
    /// A worker that is not heard for so long is lost (default 4 s; it speaks each second).
    pub heartbeat_timeout: Duration,
    /// A job that a worker does not mention is sent again after so long (default 2 s).
    pub resend_after: Duration,
    /// A process that goes on with a run waits so long for workers that outlived the last one before
    /// it gives out what they may hold (default 3 s: they try to connect every 2 s).
    pub rejoin_grace: Duration,
    /// After the last of them came back, it waits so long for the results they bring (default
    /// 500 ms).
    pub delivery_grace: Duration,
    /// If the core is not called for so long, this process stood still itself (default 1 s).
    pub stall_after: Duration,
    /// If it stood still for so long, workers may have given up their connections to it (default 2 s:
    /// they do after 3 s without a word).
    pub disconnecting_stall: Duration,
    /// Those workers may take so long to connect again before their silence counts (default 3 s: they
    /// try every 2 s).
    pub reconnect_grace: Duration,
    /// Jobs may wait so long without any worker before people are told (default 10 s).
    pub no_worker_notice: Duration,
    /// A waiting job may be taken from a busy worker for an idle one after so long (default
    /// 50 ms): less would only move short jobs about.
    pub steal_after: Duration,
    /// Jobs a worker holds per slot at most: one computes, one waits (default 2). More would queue
    /// bytes towards a worker that may freeze.
    pub jobs_per_slot: usize,
    /// A second job is sent ahead only if without it a slot would spend more than this share of its
    /// time waiting for the next order, in percent (default 4). Where jobs are long, what waits
    /// behind a slow one would hold up a search that needs results in order.
    pub prefetch_percent: u32,
    /// Results on their way to the disk beyond which nothing is given out (default 1024): memory is
    /// not there to hold what a slow disk does not take.
    pub most_unstored: usize,
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
    pub longest_time_factor: u32,
    /// Finished jobs of a kind before anything is concluded from their times (default 5).
    pub deadline_samples: usize,
    /// When nothing is left to give out, an idle slot takes a copy of a job that has been computed
    /// for this many times as long as 95 % of recent ones needed, in percent (default 150).
    pub copy_after_percent: u32,
    /// No copy is made of a job that has been computed for less (default 200 ms).
    pub least_copy_after: Duration,
    /// Overdue attempts before a job is given up (default 2; each has twice the time).
    pub give_up_after_deadlines: u32,
    /// Crashed attempts before a job is given up (default 2): a slot that crashes ran nothing
    /// else, so the job is to blame.
    pub give_up_after_crashes: u32,
    /// Lost workers that held a job, computing it or not, before it runs alone (default 2): until
    /// then it may be bad company.
    pub alone_after_losses: u32,
    /// Lost workers that held a job before it is given up (default 4): on the last two of them there
    /// was nothing else.
    pub give_up_after_losses: u32,
    /// Time between two accounts of slot time in the journal (default 60 s).
    pub account_interval: Duration,
    /// Failed jobs without any success before the run stops (default 8).
    pub stop_after_failures: u32,
}

impl Policy {
    /// For a case's model. One that ends its own runs is left to do so, and is given up only long after; one
    /// that does not repeat its bits is not copied, for the first result counts.
    pub fn of(case: &Case) -> Self {
        /// Runs that may stand before one on a machine with fewer places than slots.
        const BEFORE: f64 = 64.0;
        let (model, mut policy) = (&case.model, Self::default());
        if let Some(own) = model.deadline_s {
            let runs = BEFORE * case.objective.conditions().count() as f64;
            let guard = Duration::try_from_secs_f64(runs * own).unwrap_or(Duration::MAX);
            policy.first_deadline = guard.saturating_add(Duration::from_mins(10));
            policy.least_deadline = policy.first_deadline;
        }
        if model.repeats != Repeats::Bits {
            policy.deadline_samples = usize::MAX;
        }
        policy
    }
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            heartbeat_timeout: Duration::from_secs(4),
            resend_after: Duration::from_secs(2),
            rejoin_grace: Duration::from_secs(3),
            delivery_grace: Duration::from_millis(500),
            stall_after: Duration::from_secs(1),
            disconnecting_stall: Duration::from_secs(2),
            reconnect_grace: Duration::from_secs(3),
            no_worker_notice: Duration::from_secs(10),
            steal_after: Duration::from_millis(50),
            jobs_per_slot: 2,
            prefetch_percent: 4,
            most_unstored: 1024,
            first_deadline: Duration::from_mins(2),
            reduction_deadline: Duration::from_mins(30),
            least_deadline: Duration::from_secs(10),
            deadline_factor: 4,
            longest_time_factor: 2,
            deadline_samples: 5,
            copy_after_percent: 150,
            least_copy_after: Duration::from_millis(200),
            give_up_after_deadlines: 2,
            give_up_after_crashes: 2,
            alone_after_losses: 2,
            give_up_after_losses: 4,
            account_interval: Duration::from_mins(1),
            stop_after_failures: 8,
        }
    }
}
