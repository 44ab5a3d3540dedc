//! Who gets which job.
use super::{
    Core, membership, result,
    state::{Lease, Member},
};
use protocol::{
    id::{AttemptId, JobId, WorkerId},
    job::Failure,
    message::{Attempt, Beat, Order, ToWorker},
};
use std::time::Duration;

/// A worker has this much more time than the deadline it enforces itself.
const GRACE: Duration = Duration::from_secs(10);

/// Gives queued jobs, lowest id first, to the least loaded workers.
pub(super) fn assign(core: &mut Core, now: Duration) {
    let mut passed_over = Vec::new();
    while let Some(job) = core.queue.pop_first() {
        if let Some(worker) = pick(core, job) {
            lease(core, worker, job, now);
        } else {
            let Some(pending) = core.jobs.get(&job) else {
                continue;
            };
            // a job that only some workers may have must not hold up the others
            let special = !pending.refused_by.is_empty()
                || membership::is_suspect(pending.failures, core.options.policy.suspect);
            passed_over.push(job);
            if !special {
                break;
            }
        }
    }
    core.queue.extend(passed_over);
    steal(core, now);
}

/// The least loaded worker that may have the job.
fn pick(core: &Core, job: JobId) -> Option<WorkerId> {
    let pending = core.jobs.get(&job)?;
    let policy = &core.options.policy;
    let alone = membership::is_suspect(pending.failures, policy.suspect);
    let reserved = if alone { None } else { reserved(core) };
    let room = |member: &Member| {
        if alone {
            1
        } else {
            policy.per_slot * member.slots()
        }
    };
    core.members
        .iter()
        .filter(|(id, member)| {
            member.ready
                && !member.alone
                && member.leases.len() < room(member)
                && reserved != Some(**id)
                && !pending.refused_by.contains(id)
        })
        .min_by_key(|(_, member)| member.leases.len() * 4096 / member.slots())
        .map(|(id, _)| *id)
}

/// While a job waits to run alone, the least loaded worker gets nothing new.
fn reserved(core: &Core) -> Option<WorkerId> {
    let suspect = core.options.policy.suspect;
    core.queue
        .iter()
        .filter_map(|job| core.jobs.get(job))
        .any(|job| membership::is_suspect(job.failures, suspect))
        .then(|| {
            let ready = core
                .members
                .iter()
                .filter(|(_, member)| member.ready && !member.alone);
            ready
                .min_by_key(|(_, member)| member.leases.len())
                .map(|(id, _)| *id)
        })
        .flatten()
}

fn lease(core: &mut Core, worker: WorkerId, job: JobId, now: Duration) {
    let Some(pending) = core.jobs.get_mut(&job) else {
        return;
    };
    let Some(member) = core.members.get_mut(&worker) else {
        return;
    };
    let number = core.options.epoch << 16 | (pending.next & 0xffff);
    let attempt = Attempt {
        job,
        attempt: AttemptId(number),
    };
    if pending.next > 0 {
        core.counts.repeated += 1;
    }
    pending.next += 1;
    pending.holders.push(worker);
    let deadline = core
        .times
        .deadline(pending.failures.deadlines, &core.options.policy);
    member.alone |= membership::is_suspect(pending.failures, core.options.policy.suspect);
    member.leases.push(Lease {
        attempt,
        sent: now,
        running: None,
        deadline,
    });
    let order = order(attempt, deadline, &pending.job);
    core.send(worker, order);
}

fn order(attempt: Attempt, deadline: Duration, job: &protocol::job::Job) -> ToWorker {
    let deadline_ms = u64::try_from(deadline.as_millis()).unwrap_or(u64::MAX);
    ToWorker::Run(Box::new(Order {
        attempt,
        deadline_ms,
        job: job.clone(),
    }))
}

/// Takes a job from a worker and puts it back into the queue, unless someone else has it too.
pub(super) fn release(core: &mut Core, worker: WorkerId, job: JobId) {
    if let Some(member) = core.members.get_mut(&worker) {
        member.drop_lease(job);
    }
    if let Some(pending) = core.jobs.get_mut(&job) {
        pending.holders.retain(|holder| *holder != worker);
        if pending.holders.is_empty() {
            core.queue.insert(job);
        }
    }
}

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
    let deadline = core
        .times
        .deadline(pending.failures.deadlines, &core.options.policy);
    member.leases.push(Lease {
        attempt,
        sent: now,
        running: None,
        deadline,
    });
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
            let order = order(attempt, deadline, &pending.job);
            core.send(from, order);
        }
    }
}

/// Ends attempts that their worker should have ended itself.
pub(super) fn check_overdue(core: &mut Core, now: Duration) {
    let mut overdue = Vec::new();
    for (worker, member) in &core.members {
        for lease in &member.leases {
            let since = lease.running.map(|running| now.saturating_sub(running));
            if since.is_some_and(|since| since > lease.deadline + GRACE) {
                overdue.push((*worker, lease.attempt, lease.deadline));
            }
        }
    }
    for (worker, attempt, deadline) in overdue {
        core.send(worker, ToWorker::Cancel(attempt));
        let limit_ms = u64::try_from(deadline.as_millis()).unwrap_or(u64::MAX);
        result::failed(
            core,
            worker,
            attempt.job,
            Failure::Deadline { limit_ms },
            now,
        );
    }
}

/// With nothing left to give out, a worker without enough to do takes a waiting job from another.
fn steal(core: &mut Core, now: Duration) {
    if !core.queue.is_empty() {
        return;
    }
    let after = core.options.policy.steal_after;
    loop {
        let idle = core.members.iter().find(|(_, member)| {
            member.ready && !member.alone && member.leases.len() < member.slots()
        });
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
        release(core, busy, attempt.job);
        core.queue.remove(&attempt.job);
        lease(core, idle, attempt.job, now);
    }
}
