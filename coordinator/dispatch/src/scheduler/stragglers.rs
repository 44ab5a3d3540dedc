//! Straggler handling at the end of a generation, when the queue is empty and some slots are idle.
//!
//! Idle slots first take jobs that wait behind running ones, then copies of jobs that have run for
//! suspiciously long (see [`Policy::copy_after_percent`](super::Policy)): the first result counts, and the
//! other attempt is cancelled. A job has at most one copy at a time, and none if workers holding it were
//! lost.
use super::{
    anticipated::make_room,
    assign::{may_have, most_idle},
    lease::{lease, revoke},
    slot_time::AttemptUse,
    state::Core,
};
use protocol::{
    id::{JobId, WorkerId},
    message::Attempt,
};
use std::{cmp::Reverse, time::Duration};

/// Moves waiting jobs from busy workers to idle ones when the queue is empty.
pub(super) fn steal(core: &mut Core, now: Duration) {
    if core.queued_jobs() > 0 {
        return;
    }
    loop {
        let mut members = core.members.iter();
        let idle = members.find(|(_, member)| member.takes_jobs() && member.idle() > 0);
        let Some(idle) = idle.map(|(id, _)| *id) else {
            return;
        };
        let Some((busy, attempt)) = waiting(core, idle, now) else {
            return;
        };
        revoke(core, busy, attempt, (AttemptUse::Lost, now));
        core.queue.remove(&attempt.job);
        let repeated = core.counts.repeated;
        lease(core, idle, attempt.job, now);
        // nobody had begun it: it is neither lost nor failed
        core.counts.repeated = repeated;
    }
}

/// Finds a job that has waited long enough behind running jobs of a busy worker and that the given idle
/// worker may run.
fn waiting(core: &Core, idle: WorkerId, now: Duration) -> Option<(WorkerId, Attempt)> {
    let after = core.options.policy.steal_after;
    let mut others = core.members.iter().filter(|(id, _)| **id != idle);
    others.find_map(|(id, member)| {
        let lease = member.leases.get(member.slots()..)?.last()?;
        let long = now.saturating_sub(lease.sent) > after && lease.running.is_none();
        let pending = core.jobs.get(&lease.attempt.job)?;
        (long && may_have(core, pending, idle)).then_some((*id, lease.attempt))
    })
}

/// Gives idle slots copies of jobs that run for suspiciously long, the slowest first.
pub(super) fn copy_slow(core: &mut Core, now: Duration) {
    let has_room = most_idle(core, |_| true).is_some() || !core.anticipated.is_empty();
    if !core.waits_for_others() || !has_room {
        return;
    }
    let slow = slow(core);
    make_room(core, slow.len(), now);
    for (holder, job) in slow {
        let pending = core.jobs.get(&job);
        let suits = |id: WorkerId| {
            id != holder && pending.is_some_and(|pending| may_have(core, pending, id))
        };
        if let Some(worker) = most_idle(core, suits) {
            lease(core, worker, job, now);
        }
    }
}

/// Returns the jobs that exactly one worker holds and has run for suspiciously long, with that worker;
/// longest running first.
fn slow(core: &mut Core) -> Vec<(WorkerId, JobId)> {
    for member in core.members.values_mut() {
        member.settle(&core.clocks);
    }
    let policy = &core.options.policy;
    let mut slow = Vec::new();
    for (holder, member) in &core.members {
        for lease in member.leases.iter().take(member.slots()) {
            let Some(pending) = core.jobs.get(&lease.attempt.job) else {
                continue;
            };
            let after = core.times.copy_after(pending.job.kind(), policy);
            let is_slow = after.is_some_and(|after| lease.held > after);
            let is_requested = !core.anticipated.contains(&lease.attempt.job);
            if is_slow
                && is_requested
                && !core.must_run_alone(pending)
                && pending.holders.len() == 1
            {
                slow.push((lease.held, *holder, lease.attempt.job));
            }
        }
    }
    slow.sort_by_key(|(held, _, job)| (Reverse(*held), *job));
    slow.into_iter()
        .map(|(_, holder, job)| (holder, job))
        .collect()
}
