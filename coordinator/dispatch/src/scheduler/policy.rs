//! Scheduling policy: time limits after which workers count as lost, and retry limits for each kind of
//! failure.
//!
//! | failure | tried again | limit | afterwards |
//! |---|---|---|---|
//! | the physics (a verdict) | never | | it is the job's result |
//! | deadline | with twice the time | 2 attempts | a failed result, recorded |
//! | crashed | on any worker | 2 attempts | a failed result, recorded |
//! | its worker was lost | on any worker; alone on one after 2 | none | after 4 it waits for a worker that joins later |
//! | refused | on workers that have not refused | all have | delivered, not recorded |
//! | misconfigured | never | | delivered, not recorded |
//!
//! A recorded result is part of the run and never computed again; refused and misconfigured jobs are not
//! recorded because another build or another case may succeed. The loss of a worker is never a result: a run
//! that has nothing left but jobs that wait for new workers ends after the pause limit and can be resumed. If the
//! first 8 jobs all fail, the run stops.
use protocol::case::{Case, Reproducibility};
use std::time::Duration;

/// Default time for which a run waits while the journal cannot be written or workers are missing, long enough for
/// a person to free space on the disk or to start workers.
pub const PAUSE_LIMIT: Duration = Duration::from_mins(10);

/// Time limits and retry limits of the scheduler; the defaults are measured to give no false loss of a worker
/// on a machine with thirty times more runnable threads than cores.
#[derive(Clone, Debug, PartialEq)]
pub struct Policy {
    /// Silence after which a worker is lost (default 4 s; heartbeats come every second).
    pub heartbeat_timeout: Duration,
    /// Time after which an order is sent again if the worker's heartbeats do not mention the job (default 2
    /// s).
    pub resend_after: Duration,
    /// Time for which a coordinator that resumes a run waits for workers of the previous process before it
    /// dispatches the jobs they may hold (default 3 s: workers try to connect every 2 s).
    pub rejoin_grace: Duration,
    /// Time for which a restarted coordinator waits for results after the last of the expected workers has
    /// returned (default 500 ms).
    pub delivery_grace: Duration,
    /// Gap between two calls of the core beyond which the coordinator process itself counts as stalled
    /// (default 1 s).
    pub stall_after: Duration,
    /// Shortest stall of the coordinator during which workers may have dropped their connections (default 2
    /// s; workers do so after 3 s of silence).
    pub disconnecting_stall: Duration,
    /// Time allowed for reconnecting after a stall of the coordinator of at least `disconnecting_stall`,
    /// before a worker's silence counts again (default 3 s: workers try every 2 s).
    pub reconnect_grace: Duration,
    /// Time for which jobs may wait without any worker before the user is notified (default 10 s).
    pub no_worker_notice: Duration,
    /// Time after which a waiting job may be taken from a busy worker for an idle one (default 50 ms; a
    /// shorter time would only move short jobs about).
    pub steal_after: Duration,
    /// Largest number of jobs a worker holds per slot: one running, one waiting (default 2). More would queue
    /// bytes towards a worker that may freeze.
    pub jobs_per_slot: usize,
    /// Share of slot time spent waiting for the next order, in percent, above which a second job is sent
    /// ahead (default 4). Where jobs are long, a job waiting behind a slow one would hold up a search that
    /// needs results in order.
    pub prefetch_percent: u32,
    /// Number of accepted but unstored results beyond which no job is dispatched (default 1024), so that a
    /// slow disk does not fill the memory.
    pub most_unstored: usize,
    /// Deadline of an attempt while fewer than [`Self::deadline_samples`] jobs of its kind are done (default
    /// 120 s).
    pub first_deadline: Duration,
    /// Deadline for the reduction of a horse head, before samples exist; requested once, and its time grows
    /// with the mesh (default 30 min).
    pub reduction_deadline: Duration,
    /// Lower limit of the deadline derived from measured job times (default 10 s).
    pub least_deadline: Duration,
    /// Ratio of an attempt's deadline to the 95th percentile of the durations of recent jobs of its kind
    /// (default 4).
    pub deadline_factor: u32,
    /// Minimum ratio of an attempt's deadline to the longest time that any job of its kind took in this
    /// process (default 2): a duration that succeeded once must stay allowed.
    pub longest_time_factor: u32,
    /// Number of finished jobs of a kind needed before their times are used to set deadlines and start copies
    /// (default 5).
    pub deadline_samples: usize,
    /// Running time after which an idle slot gets a copy of a job when the queue is empty, in percent of the
    /// 95th percentile of recent jobs (default 150).
    pub copy_after_percent: u32,
    /// Shortest running time after which a job may be copied (default 200 ms).
    pub least_copy_after: Duration,
    /// Number of overdue attempts after which a job is given up (default 2; the time allowed doubles each
    /// time).
    pub give_up_after_deadlines: u32,
    /// Number of crashed attempts after which a job is given up (default 2): a slot runs a single job at a
    /// time, so the job is the cause.
    pub give_up_after_crashes: u32,
    /// Number of lost workers that held a job, running or not, after which the job runs alone (default 2):
    /// until then another job on those workers may be the cause.
    pub alone_after_losses: u32,
    /// Number of lost workers that held a job after which the job is given only to workers that join after the
    /// last loss (default 4): the last two of them held no other job.
    pub wait_after_losses: u32,
    /// Time without a result after which a run ends whose only jobs left wait for new workers (default 10 min).
    pub pause_limit: Duration,
    /// Time between two slot-time accounts in the journal (default 60 s).
    pub account_interval: Duration,
    /// Number of failed jobs without any success at which the run stops (default 8).
    pub stop_after_failures: u32,
}

impl Policy {
    /// Returns the policy for a case's model. A model with a time limit of its own ends its runs itself, so
    /// its jobs are given up only long after that limit; a model whose results are not bitwise repeatable is
    /// never copied, since the first result counts.
    pub fn of(case: &Case) -> Self {
        /// Assumed upper limit of the number of runs that wait ahead of a given run on a machine that
        /// executes fewer runs simultaneously than it has slots.
        const MAX_QUEUED_RUNS: f64 = 64.0;
        let (model, mut policy) = (&case.model, Self::default());
        if let Some(own) = model.deadline_s {
            let runs = MAX_QUEUED_RUNS * case.objective.conditions().count() as f64;
            let guard = Duration::try_from_secs_f64(runs * own).unwrap_or(Duration::MAX);
            policy.first_deadline = guard.saturating_add(Duration::from_mins(10));
            policy.least_deadline = policy.first_deadline;
        }
        if model.repeats != Reproducibility::Bits {
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
            wait_after_losses: 4,
            pause_limit: PAUSE_LIMIT,
            account_interval: Duration::from_mins(1),
            stop_after_failures: 8,
        }
    }
}
