//! What a worker says that it holds, against what it should hold.
use super::{Core, assign, state::Lease};
use protocol::{
    id::{JobId, WorkerId},
    message::{Beat, ToWorker},
};
use std::time::Duration;

/// If a worker says that it holds a queued job already, it may keep it: it is one that outlived
/// the process that gave it out.
pub(super) fn adopt(core: &mut Core, job: JobId, now: Duration) {
    if !core.queue.contains(&job) {
        return;
    }
    let claim = core.members.iter().find_map(|(id, member)| {
        let claim = member.claims.iter().find(|attempt| attempt.job == job)?;
        Some((*id, *claim))
    });
    let Some((worker, attempt)) = claim else {
        return;
    };
    let Some(pending) = core.jobs.get_mut(&job) else {
        return;
    };
    let Some(member) = core.members.get_mut(&worker) else {
        return;
    };
    member.claims.retain(|claim| *claim != attempt);
    let (kind, overdue) = (pending.job.kind(), pending.failures.deadlines);
    let deadline = core.times.deadline(kind, overdue, &core.options.policy);
    member.add_lease(Lease::new(attempt, deadline, now), &core.clocks);
    pending.holders.push(worker);
    core.queue.remove(&job);
}

/// Compares what a worker holds with what it should hold.
pub(super) fn reconcile(core: &mut Core, from: WorkerId, beat: &Beat, now: Duration) {
    let computing = beat.running.iter().chain(&beat.waiting);
    for attempt in computing.clone() {
        let job = attempt.job;
        let leased = core
            .members
            .get(&from)
            .is_some_and(|member| member.holds(job));
        if leased {
            continue;
        }
        if core.has_finished(job) {
            core.send(from, ToWorker::Cancel(*attempt));
        } else if let Some(member) = core.members.get_mut(&from) {
            member.claims.push(*attempt);
            adopt(core, job, now);
        }
    }
    let unmentioned = core.options.policy.unmentioned;
    let Some(member) = core.members.get_mut(&from) else {
        return;
    };
    let mut again = Vec::new();
    for lease in &mut member.leases {
        let attempt = lease.attempt;
        let mentioned = computing
            .clone()
            .chain(&beat.finished)
            .any(|held| *held == attempt);
        if !mentioned && now.saturating_sub(lease.sent) > unmentioned {
            lease.sent = now;
            again.push((attempt, lease.deadline));
        }
    }
    for (attempt, deadline) in again {
        if let Some(pending) = core.jobs.get(&attempt.job) {
            let order = assign::order(attempt, deadline, &pending.job);
            core.send(from, order);
        }
    }
}
