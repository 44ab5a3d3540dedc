//! Reconciliation of the attempts that a worker reports in its heartbeat with the leases of the coordinator.
use super::{
    lease::{adopt, order},
    state::Core,
};
use protocol::{
    id::WorkerId,
    message::{Heartbeat, ToWorker},
};
use std::time::Duration;

/// Reconciles the attempts in a worker's heartbeat with its leases: cancels attempts of finished jobs, lets
/// the worker keep attempts of queued jobs, and resends lost orders.
pub(super) fn reconcile(core: &mut Core, from: WorkerId, beat: &Heartbeat, now: Duration) {
    mark(core, from, beat, now);
    let computing = beat.running.iter().chain(&beat.waiting);
    for attempt in computing.clone() {
        let job = attempt.job;
        let Some(member) = core.members.get(&from) else {
            return;
        };
        if member.holds(job) {
            continue;
        }
        // the worker has not heard yet that the attempt was withdrawn, or this heartbeat is older than that: it
        // cannot keep it
        let is_revoked = member.revoked.iter().any(|(revoked, _)| revoked == attempt);
        if is_revoked || core.has_finished(job) || core.is_orphan(job) {
            core.send(from, ToWorker::Cancel(*attempt));
        } else if let Some(member) = core.members.get_mut(&from) {
            member.claims.push(*attempt);
            adopt(core, job, now);
        }
    }
    resend(core, from, beat, now);
}

/// Marks leases as running if the heartbeat reports so, and forgets withdrawn attempts that the worker no
/// longer holds.
fn mark(core: &mut Core, from: WorkerId, beat: &Heartbeat, now: Duration) {
    let resend_after = core.options.policy.resend_after;
    let Some(member) = core.members.get_mut(&from) else {
        return;
    };
    for lease in &mut member.leases {
        if lease.running.is_none() && beat.running.contains(&lease.attempt) {
            lease.running = Some(now);
        }
    }
    member.claims.clear();
    member.revoked.retain(|(attempt, at)| {
        let mut held = beat.running.iter().chain(&beat.waiting);
        held.any(|held| held == attempt) || now.saturating_sub(*at) < resend_after
    });
}

/// Sends the orders of those leases again that the worker's heartbeat does not mention.
fn resend(core: &mut Core, from: WorkerId, beat: &Heartbeat, now: Duration) {
    let resend_after = core.options.policy.resend_after;
    let Some(member) = core.members.get_mut(&from) else {
        return;
    };
    let known = [&beat.running, &beat.waiting, &beat.finished];
    let mut again = Vec::new();
    for lease in &mut member.leases {
        let mentioned = known.iter().any(|held| held.contains(&lease.attempt));
        if !mentioned && now.saturating_sub(lease.sent) > resend_after {
            lease.sent = now;
            again.push((lease.attempt, lease.deadline));
        }
    }
    for (attempt, deadline) in again {
        if let Some(pending) = core.jobs.get(&attempt.job) {
            let order = order(attempt, deadline, &pending.job);
            core.send(from, order);
        }
    }
}
