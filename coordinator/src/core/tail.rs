//! The tail of a generation: nothing is left to give out, and some slots have nothing to do.
//!
//! First they take jobs that wait behind others. Then they take copies of jobs that have been
//! computed for suspiciously long (see [`Policy::copy_percent`](super::Policy)): the first result
//! counts, and whoever is late is told to stop. A job is copied once at a time, and never if
//! workers were lost over it.
use super::{
    Core,
    account::{self, Use},
    assign, membership,
};
use protocol::{
    id::{JobId, WorkerId},
    message::ToWorker,
};
use std::time::Duration;

/// With nothing left to give out, a worker without enough to do takes a waiting job from another.
pub(super) fn steal(core: &mut Core, now: Duration) {
    if !core.queue.is_empty() || core.paused {
        return;
    }
    let after = core.options.policy.steal_after;
    loop {
        let idle = core
            .members
            .iter()
            .find(|(_, member)| member.ready && !member.alone && member.idle() > 0);
        let Some(idle) = idle.map(|(id, _)| *id) else {
            return;
        };
        let waiting = core.members.iter().find_map(|(id, member)| {
            let behind = member.leases.get(member.slots()..)?;
            let lease = behind
                .last()
                .filter(|lease| now.saturating_sub(lease.sent) > after)?;
            let refused = core
                .jobs
                .get(&lease.attempt.job)?
                .refused_by
                .contains(&idle);
            (lease.running.is_none() && !refused && *id != idle).then_some((*id, lease.attempt))
        });
        let Some((busy, attempt)) = waiting else {
            return;
        };
        core.send(busy, ToWorker::Cancel(attempt));
        if let Some(member) = core.members.get_mut(&busy) {
            member.taken.push((attempt, now));
        }
        assign::release(core, busy, attempt.job, Use::Lost);
        core.queue.remove(&attempt.job);
        assign::lease(core, idle, attempt.job, now);
    }
}

/// Gives idle slots copies of jobs that take suspiciously long, the slowest first.
pub(super) fn copy_slow(core: &mut Core, now: Duration) {
    if !core.queue.is_empty() || core.paused || !core.clocks_wait() {
        return;
    }
    let idle = |core: &Core, not: WorkerId| {
        let free = core
            .members
            .iter()
            .filter(|(id, member)| member.ready && !member.alone && **id != not);
        let most = free.max_by_key(|(_, member)| member.idle() * 4096 / member.slots());
        most.filter(|(_, member)| member.idle() > 0)
            .map(|(id, _)| *id)
    };
    if idle(core, WorkerId(u64::MAX)).is_none() {
        return;
    }
    for (holder, job) in slow(core) {
        let Some(worker) = idle(core, holder) else {
            continue;
        };
        assign::lease(core, worker, job, now);
    }
}

/// Jobs with one holder that has computed them for too long, with the holder; longest first.
fn slow(core: &mut Core) -> Vec<(WorkerId, JobId)> {
    let (policy, clocks) = (&core.options.policy, core.clocks);
    let mut slow = Vec::new();
    for (holder, member) in &mut core.members {
        account::settle(member, &clocks);
        for lease in member
            .leases
            .iter()
            .take(member.announcement.slots as usize)
        {
            let Some(pending) = core.jobs.get(&lease.attempt.job) else {
                continue;
            };
            let alone = membership::is_suspect(pending.failures, policy.suspect);
            let after = core.times.copy_after(pending.job.kind(), policy);
            let is_slow = after.is_some_and(|after| lease.held > after);
            if is_slow && !alone && pending.holders.len() == 1 {
                slow.push((lease.held, *holder, lease.attempt.job));
            }
        }
    }
    slow.sort_by_key(|(held, _, job)| (std::cmp::Reverse(*held), *job));
    slow.into_iter()
        .map(|(_, holder, job)| (holder, job))
        .collect()
}
