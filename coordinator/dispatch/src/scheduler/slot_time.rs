//! Accounting of slot time: every moment of every slot is counted exactly once, under one kind of use.
//!
//! A slot is either computing or not. Computing time is attributed when the attempt ends: *useful* if its
//! result became the job's result, *speculative* if another attempt's result was accepted or the job was
//! anticipated and has not been requested, *failed*, or *lost*. Idle time is *barrier* while the run waits for results of other slots (all requested jobs are
//! dispatched), otherwise *starved* (the worker still fetches the case, an order is in transit, the journal
//! cannot be written, or no job is requested).
//!
//! The core sees a slot computing from the order to the result; the worker reports the true duration. The
//! difference is transit time and counts as starved. This file knows neither workers nor jobs: its callers
//! pass the number of idle slots and the use of each attempt.
use journal::event::Spent;
use std::time::Duration;

/// Cumulative clocks of the run, shared by all workers' slot-time accounts: time counted as barrier or
/// starved for idle slots, and computing time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clocks {
    pub(super) now: Duration,
    /// Cumulative time during which at least one worker held a job.
    pub(super) computing: Duration,
    barrier: Duration,
    starved: Duration,
    /// State of the run since the time `now` to which the clocks were last advanced; determines the clock
    /// that runs.
    doing: WorkState,
}

/// State of the run that determines under which kind idle time is counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WorkState {
    /// Whether at least one worker holds a job.
    pub(super) computes: bool,
    /// Whether idle slots wait only for results of other slots (barrier).
    pub(super) waits_for_others: bool,
}

impl Clocks {
    /// Advances the clocks to the time `now`, adding the elapsed time under the run's current state.
    pub(super) fn advance(&mut self, now: Duration) {
        let passed = now.saturating_sub(self.now);
        if self.doing.computes {
            self.computing += passed;
        }
        if self.doing.waits_for_others {
            self.barrier += passed;
        } else {
            self.starved += passed;
        }
        self.now = self.now.max(now);
    }

    /// Sets the state of the run under which time is counted from now on.
    pub(super) const fn set_state(&mut self, doing: WorkState) {
        self.doing = doing;
    }
}

/// Use of the slot time of an ended attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AttemptUse {
    /// The attempt's result became the job's result, after the given time in the slot \[us\].
    Useful(u64),
    /// The attempt computed an anticipated job, in the given time in the slot \[us\].
    Ahead(u64),
    /// The attempt failed, after the given time in the slot \[us\].
    Failed(u64),
    /// The coordinator ended the attempt because it was overdue.
    Overdue,
    /// The result of another attempt was accepted first.
    Speculative,
    /// The attempt was lost or taken away, and its result is not awaited.
    Lost,
}

impl AttemptUse {
    /// Returns the computing time of the attempt as reported by the worker; `None` if no report exists.
    pub(super) const fn reported_time(self) -> Option<Duration> {
        match self {
            Self::Useful(us) | Self::Ahead(us) | Self::Failed(us) => {
                Some(Duration::from_micros(us))
            }
            Self::Overdue | Self::Speculative | Self::Lost => None,
        }
    }
}

/// Slot-time account of one worker: time by kind of use.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlotTime {
    /// Readings of the run's clocks when this account was last brought up to date.
    settled_at: Clocks,
    useful: Duration,
    barrier: Duration,
    starved: Duration,
    speculative: Duration,
    failed: Duration,
    lost: Duration,
    /// Time between order and result in excess of the computing time reported by the worker; counts as
    /// transit unless a later result turns out to have been started in it.
    pub(super) in_transit: Duration,
}

impl SlotTime {
    /// Creates an empty slot-time account that starts at the current clocks.
    pub(super) fn since(clocks: &Clocks) -> Self {
        Self {
            settled_at: *clocks,
            ..Self::default()
        }
    }

    /// Returns the time that has passed since this slot-time account was last brought up to date.
    pub(super) fn unsettled(&self, clocks: &Clocks) -> Duration {
        clocks.now.saturating_sub(self.settled_at.now)
    }

    /// Returns the worker's slot-time account brought up to the given clocks, adding the idle time of `idle`
    /// slots; for a worker that is not `ready` all of it counts as starved.
    pub(super) fn until(mut self, clocks: &Clocks, idle: u32, ready: bool) -> Self {
        let barrier = clocks.barrier.saturating_sub(self.settled_at.barrier);
        let starved = clocks.starved.saturating_sub(self.settled_at.starved);
        if ready {
            self.barrier += barrier * idle;
            self.starved += starved * idle;
        } else {
            self.starved += (barrier + starved) * idle;
        }
        self.settled_at = *clocks;
        self
    }

    /// Adds the slot time `spent` on an ended attempt to the account, under the attempt's use.
    pub(super) fn add(&mut self, what: AttemptUse, spent: Duration) {
        let kind = match what {
            AttemptUse::Useful(_) => &mut self.useful,
            AttemptUse::Failed(_) | AttemptUse::Overdue => &mut self.failed,
            AttemptUse::Speculative | AttemptUse::Ahead(_) => &mut self.speculative,
            AttemptUse::Lost => &mut self.lost,
        };
        *kind += spent;
    }

    /// Makes time that was spent on an anticipated job useful, because the job was requested.
    pub(super) fn claim(&mut self, time: Duration) {
        self.speculative = self.speculative.saturating_sub(time);
        self.useful += time;
    }

    /// Converts the account into its journal form; `connected_us` is the connected time of all slots, and the
    /// time `computing` of attempts still running counts as useful.
    pub(super) fn to_spent(self, connected_us: u64, computing: Duration) -> Spent {
        Spent {
            connected_us,
            useful_us: micros(self.useful + computing),
            barrier_us: micros(self.barrier),
            starved_us: micros(self.starved + self.in_transit),
            speculative_us: micros(self.speculative),
            failed_us: micros(self.failed),
            lost_us: micros(self.lost),
        }
    }
}

/// Converts a duration to microseconds, saturating.
pub(super) fn micros(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}
