//! How slots spend their time: every moment of every slot is counted once, under one kind.
//!
//! A slot computes, or it does not. What it computed is named when the attempt ends: *useful* if
//! its result is the job's result, *speculative* if another's was, *failed*, or *lost*. While it
//! does not compute, either the run waits for results of others (*barrier*: everything that was
//! asked for is given out) or it does not (*starved*: the worker still fetches the case, an order
//! is on its way, the journal cannot be written, or nothing is asked for).
//!
//! The core sees a slot computing from the order to the result; the worker says how long it really
//! took. The difference is time on the way, and counts as starved.
use super::state::{Lease, Member};
use protocol::event::Spent;
use std::time::Duration;

/// Time without a job, by what the run was doing: one for all slots, since it is the same for all.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clocks {
    pub(super) now: Duration,
    barrier: Duration,
    starved: Duration,
    /// What the run has been doing since `now`.
    waits_for_others: bool,
}

impl Clocks {
    /// Time goes on.
    pub(super) fn advance(&mut self, now: Duration) {
        let passed = now.saturating_sub(self.now);
        if self.waits_for_others {
            self.barrier += passed;
        } else {
            self.starved += passed;
        }
        self.now = self.now.max(now);
    }

    /// From now on an idle slot waits for others, or for something else.
    pub(super) const fn set_waiting(&mut self, waits_for_others: bool) {
        self.waits_for_others = waits_for_others;
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

/// One worker's account.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Purse {
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
    on_the_way: Duration,
}

impl Purse {
    /// An account from now on.
    pub(super) fn new(clocks: &Clocks) -> Self {
        Self {
            seen: *clocks,
            ..Self::default()
        }
    }
}

/// Writes down what happened since the last time; to be called before the number of jobs a worker
/// computes, or its readiness, changes.
pub(super) fn settle(member: &mut Member, clocks: &Clocks) {
    let passed = clocks.now.saturating_sub(member.purse.seen.now);
    let slots = member.slots();
    member.purse = settled(member, clocks);
    for lease in member.leases.iter_mut().take(slots) {
        lease.held += passed;
    }
}

fn settled(member: &Member, clocks: &Clocks) -> Purse {
    let mut purse = member.purse;
    let idle = member.slots().saturating_sub(member.leases.len());
    let idle = u32::try_from(idle).unwrap_or(u32::MAX);
    let barrier = clocks.barrier.saturating_sub(purse.seen.barrier);
    let starved = clocks.starved.saturating_sub(purse.seen.starved);
    if member.ready {
        purse.barrier += barrier * idle;
        purse.starved += starved * idle;
    } else {
        purse.starved += (barrier + starved) * idle;
    }
    purse.seen = *clocks;
    purse
}

/// Names what an attempt that is over was.
pub(super) fn attribute(member: &mut Member, lease: &Lease, what: Use) {
    match what {
        Use::Useful(us) => {
            let spent = said(member, lease, us);
            member.purse.useful += spent;
        }
        Use::Failed(us) => {
            let spent = said(member, lease, us);
            member.purse.failed += spent;
        }
        Use::Overdue => member.purse.failed += lease.held,
        Use::Speculative => member.purse.speculative += lease.held,
        Use::Lost => member.purse.lost += lease.held,
    }
}

/// How much of the time that the worker says \[us\] it can have spent, as far as is known here.
///
/// Orders may arrive in another order than they were sent in, so that another lease was held to be
/// computed meanwhile; time is taken from there, never made.
fn said(member: &mut Member, lease: &Lease, us: u64) -> Duration {
    let wanted = Duration::from_micros(us);
    let mut found = lease.held + member.purse.on_the_way;
    for other in &mut member.leases {
        let missing = wanted.saturating_sub(found).min(other.held);
        other.held -= missing;
        found += missing;
    }
    let spent = wanted.min(found);
    member.purse.on_the_way = found.saturating_sub(spent);
    spent
}

/// The account of a worker until now; what it computes is held to be useful.
pub(super) fn statement(member: &Member, clocks: &Clocks) -> Spent {
    let purse = settled(member, clocks);
    let passed = clocks.now.saturating_sub(member.purse.seen.now);
    let computing: Duration = member
        .leases
        .iter()
        .take(member.slots())
        .map(|lease| lease.held + passed)
        .sum();
    let us = |time: Duration| u64::try_from(time.as_micros()).unwrap_or(u64::MAX);
    let connected = clocks.now.saturating_sub(member.since);
    Spent {
        connected_us: us(connected).saturating_mul(u64::from(member.announcement.slots)),
        useful_us: us(purse.useful + computing),
        barrier_us: us(purse.barrier),
        starved_us: us(purse.starved + purse.on_the_way),
        speculative_us: us(purse.speculative),
        failed_us: us(purse.failed),
        lost_us: us(purse.lost),
    }
}
