//! How slots spend their time: every moment of every slot is counted once, under one kind.
//!
//! A slot computes, or it does not. What it computed is named when the attempt ends: *useful* if
//! its result is the job's result, *speculative* if another's was, *failed*, or *lost*. While it
//! does not compute, either the run waits for results of others (*barrier*: everything that was
//! asked for is given out) or it does not (*starved*: the worker still fetches the case, an order
//! is on its way, the journal cannot be written, or nothing is asked for).
//!
//! The core sees a slot computing from the order to the result; the worker says how long it really
//! took. The difference is time on the way, and counts as starved. This file knows neither workers
//! nor jobs: whoever holds them says how many slots are idle and what an attempt was.
use protocol::event::Spent;
use std::time::Duration;

/// Time without a job, by what the run was doing: one for all slots, since it is the same for all.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clocks {
    pub(super) now: Duration,
    /// For how long anybody held a job.
    pub(super) computing: Duration,
    barrier: Duration,
    starved: Duration,
    /// What the run has been doing since `now`.
    doing: Doing,
}

/// What a run does until something else happens.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Doing {
    /// Somebody holds a job.
    pub(super) computes: bool,
    /// An idle slot waits for what others compute, and for nothing else.
    pub(super) waits_for_others: bool,
}

impl Clocks {
    /// Time goes on.
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

    /// What the run does from now on.
    pub(super) const fn go_on(&mut self, doing: Doing) {
        self.doing = doing;
    }
}

/// What became of an attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// Its result is the job's result, after so long in the slot \[us\].
    Useful(u64),
    /// It failed, after so long in the slot \[us\].
    Failed(u64),
    /// It was ended as failed by the core.
    Overdue,
    /// Another one's result came first.
    Speculative,
    /// Nobody will ever answer.
    Lost,
}

impl Use {
    /// How long the worker says that it was in the slot.
    pub(super) const fn said(self) -> Option<Duration> {
        match self {
            Self::Useful(us) | Self::Failed(us) => Some(Duration::from_micros(us)),
            Self::Overdue | Self::Speculative | Self::Lost => None,
        }
    }
}

/// How the slots of one worker spent their time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlotTime {
    /// State of the clocks when everything was last written down.
    seen: Clocks,
    useful: Duration,
    barrier: Duration,
    starved: Duration,
    speculative: Duration,
    failed: Duration,
    lost: Duration,
    /// Seen as computing beyond what workers said: on the way, unless a later result turns out to
    /// have been begun meanwhile.
    pub(super) on_the_way: Duration,
}

impl SlotTime {
    /// From now on.
    pub(super) fn since(clocks: &Clocks) -> Self {
        Self {
            seen: *clocks,
            ..Self::default()
        }
    }

    /// What has passed since everything was last written down.
    pub(super) fn unwritten(&self, clocks: &Clocks) -> Duration {
        clocks.now.saturating_sub(self.seen.now)
    }

    /// The same with the time since then, for which so many slots were idle, of a worker that could
    /// be given jobs or could not.
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

    /// Writes down an attempt that took so long.
    pub(super) fn add(&mut self, what: Use, spent: Duration) {
        let kind = match what {
            Use::Useful(_) => &mut self.useful,
            Use::Failed(_) | Use::Overdue => &mut self.failed,
            Use::Speculative => &mut self.speculative,
            Use::Lost => &mut self.lost,
        };
        *kind += spent;
    }

    /// As it is written down, with the time of all slots together and what is being computed, which
    /// is held to be useful.
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

/// As microseconds on the wire.
pub(super) fn micros(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}
