//! Accounting of slot time: every moment of every slot is counted exactly once, under one kind of use.
//!
//! A slot is either computing or not. Computing time is attributed when the attempt ends: *useful* if its
//! result became the job's result, *speculative* if another attempt's result was accepted, *failed*, or
//! *lost*. Idle time is *barrier* while the run waits for results of other slots (all requested jobs are
//! dispatched), otherwise *starved* (the worker still fetches the case, an order is in transit, the journal
//! cannot be written, or no job is requested).
//!
//! The core sees a slot computing from the order to the result; the worker reports the true duration. The
//! difference is transit time and counts as starved. This file knows neither workers nor jobs: its callers
//! pass the number of idle slots and the use of each attempt.
use protocol::event::Spent;
use std::time::Duration;

/// Cumulative clocks of the run's barrier, starved and computing time, shared by all slots.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clocks {
    pub(super) now: Duration,
    /// Cumulative time during which at least one worker held a job.
    pub(super) computing: Duration,
    barrier: Duration,
    starved: Duration,
    /// State of the run since `now`.
    doing: Doing,
}

/// State of the run that determines under which kind idle time is counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Doing {
    /// Whether at least one worker holds a job.
    pub(super) computes: bool,
    /// Whether idle slots wait only for results of other slots (barrier).
    pub(super) waits_for_others: bool,
}

impl Clocks {
    /// Advances the clocks to a time, under the current state.
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

    /// Sets the state of the run from now on.
    pub(super) const fn go_on(&mut self, doing: Doing) {
        self.doing = doing;
    }
}

/// Use of the slot time of an ended attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// The attempt's result became the job's result, after the given time in the slot \[us\].
    Useful(u64),
    /// The attempt failed, after the given time in the slot \[us\].
    Failed(u64),
    /// The coordinator ended the attempt because it was overdue.
    Overdue,
    /// The result of another attempt was accepted first.
    Speculative,
    /// The attempt was lost or taken away, and its result is not awaited.
    Lost,
}

impl Use {
    /// Returns the time in the slot as reported by the worker, if it reported one.
    pub(super) const fn said(self) -> Option<Duration> {
        match self {
            Self::Useful(us) | Self::Failed(us) => Some(Duration::from_micros(us)),
            Self::Overdue | Self::Speculative | Self::Lost => None,
        }
    }
}

/// Slot time of one worker, by use.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlotTime {
    /// Clocks at the last settlement.
    seen: Clocks,
    useful: Duration,
    barrier: Duration,
    starved: Duration,
    speculative: Duration,
    failed: Duration,
    lost: Duration,
    /// Time seen as computing in excess of the times reported by the worker: transit time, unless a later
    /// result turns out to have been started in it.
    pub(super) on_the_way: Duration,
}

impl SlotTime {
    /// Creates an empty account starting at the current clocks.
    pub(super) fn since(clocks: &Clocks) -> Self {
        Self {
            seen: *clocks,
            ..Self::default()
        }
    }

    /// Returns the time since the last settlement.
    pub(super) fn unwritten(&self, clocks: &Clocks) -> Duration {
        clocks.now.saturating_sub(self.seen.now)
    }

    /// Returns the account extended to the given clocks, with the number of slots idle since the last
    /// settlement and whether the worker was ready; idle time of a worker that is not ready is starved.
    pub(super) fn until(mut self, clocks: &Clocks, idle: u32, ready: bool) -> Self {
        let barrier = clocks.barrier.saturating_sub(self.seen.barrier);
        let starved = clocks.starved.saturating_sub(self.seen.starved);
        if ready {
            self.barrier += barrier * idle;
            self.starved += starved * idle;
        } else {
            self.starved += (barrier + starved) * idle;
        }
        self.seen = *clocks;
        self
    }

    /// Adds the duration of an ended attempt under its use.
    pub(super) fn add(&mut self, what: Use, spent: Duration) {
        let kind = match what {
            Use::Useful(_) => &mut self.useful,
            Use::Failed(_) | Use::Overdue => &mut self.failed,
            Use::Speculative => &mut self.speculative,
            Use::Lost => &mut self.lost,
        };
        *kind += spent;
    }

    /// Converts the account into journal form, with the connected time of all slots; the time of running
    /// attempts counts as useful.
    pub(super) fn stated(&self, connected_us: u64, computing: Duration) -> Spent {
        Spent {
            connected_us,
            useful_us: micros(self.useful + computing),
            barrier_us: micros(self.barrier),
            starved_us: micros(self.starved + self.on_the_way),
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
