//! Who gets which job.
use super::{
    Core,
    account::{self, Use},
    membership, result,
    state::{Lease, Member},
    tail,
};
use protocol::{
    id::{AttemptId, JobId, WorkerId},
    job::Failure,
    message::{Attempt, Order, ToWorker},
};
use std::time::Duration;

/// A worker has this many times the deadline that it enforces itself, since it does not count the
/// time for which a job got no processor.
const PATIENCE: u32 = 8;
/// And this much more.
const GRACE: Duration = Duration::from_secs(10);
/// The attempt of a failure that the coordinator states itself.
pub(super) const STATED: AttemptId = AttemptId(u32::MAX);

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
    tail::steal(core, now);
}

/// The least loaded worker that may have the job.
fn pick(core: &Core, job: JobId) -> Option<WorkerId> {
    let pending = core.jobs.get(&job)?;
    let policy = &core.options.policy;
    let alone = membership::is_suspect(pending.failures, policy.suspect);
    let reserved = if alone { None } else { reserved(core) };
    let kind = pending.job.kind();
    let ahead = core.times.needs_prefetch(kind, core.latency, policy);
    let room = |member: &Member| match (alone, ahead) {
        (true, _) => 1,
        (false, true) => policy.per_slot * member.slots(),
        (false, false) => member.slots(),
    };
    core.members
        .iter()
        .filter(|(id, member)| {
            member.ready
                && !member.alone
                && member.leases.len() < room(member)
                && reserved != Some(**id)
                && !pending.refused_by.contains(id)
                && (!alone || member.taken.is_empty())
        })
        .min_by_key(|(_, member)| member.leases.len() * 4096 / member.slots())
        .map(|(id, _)| *id)
}

/// While a job waits to run alone, the least loaded worker that may have it gets nothing new.
fn reserved(core: &Core) -> Option<WorkerId> {
    let mut suspects = core.suspects.iter().filter_map(|job| core.jobs.get(job));
    let waiting = suspects.find(|job| job.holders.is_empty())?;
    let ready = core
        .members
        .iter()
        .filter(|(id, member)| member.ready && !member.alone && !waiting.refused_by.contains(id));
    ready
        .min_by_key(|(_, member)| member.leases.len())
        .map(|(id, _)| *id)
}

/// The name of an attempt: no other process of the run gives the same one.
const fn offer(epoch: u32, number: u32) -> AttemptId {
    AttemptId(epoch << 16 | (number & 0xffff))
}

/// Which process of the run offered an attempt, from 1, and how many
/// offers of its job went before there; none for what the coordinator stated itself.
pub fn offered(attempt: AttemptId) -> Option<(u32, u32)> {
    let AttemptId(number) = attempt;
    (attempt != STATED).then_some((number >> 16, number & 0xffff))
}

/// Gives a worker a job.
pub(super) fn lease(core: &mut Core, worker: WorkerId, job: JobId, now: Duration) {
    let Some(pending) = core.jobs.get_mut(&job) else {
        return;
    };
    let Some(member) = core.members.get_mut(&worker) else {
        return;
    };
    let attempt = Attempt {
        job,
        attempt: offer(core.options.epoch, pending.next),
    };
    if !pending.holders.is_empty() {
        core.counts.copies += 1;
    } else if pending.next > 0 {
        core.counts.repeated += 1;
    }
    pending.next += 1;
    pending.holders.push(worker);
    let (kind, overdue) = (pending.job.kind(), pending.failures.deadlines);
    let deadline = core.times.deadline(kind, overdue, &core.options.policy);
    member.alone |= membership::is_suspect(pending.failures, core.options.policy.suspect);
    member.add_lease(Lease::new(attempt, deadline, now), &core.clocks);
    let order = order(attempt, deadline, &pending.job);
    core.send(worker, order);
}

pub(super) fn order(attempt: Attempt, deadline: Duration, job: &protocol::job::Job) -> ToWorker {
    let deadline_ms = u64::try_from(deadline.as_millis()).unwrap_or(u64::MAX);
    ToWorker::Run(Box::new(Order {
        attempt,
        deadline_ms,
        job: job.clone(),
    }))
}

/// Takes a job from a worker and puts it back into the queue, unless someone else has it too.
pub(super) fn release(core: &mut Core, worker: WorkerId, job: JobId, what: Use) {
    if let Some(member) = core.members.get_mut(&worker)
        && let Some(lease) = member.drop_lease(job, &core.clocks)
    {
        account::attribute(member, &lease, what);
    }
    requeue(core, worker, job);
}

/// A worker no longer holds a job: if nobody else does, it waits again.
pub(super) fn requeue(core: &mut Core, worker: WorkerId, job: JobId) {
    if let Some(pending) = core.jobs.get_mut(&job) {
        pending.holders.retain(|holder| *holder != worker);
        if pending.holders.is_empty() {
            core.queue.insert(job);
        }
    }
}

/// Ends attempts that their worker should have ended itself.
pub(super) fn check_overdue(core: &mut Core, now: Duration) {
    let mut overdue = Vec::new();
    for (worker, member) in &core.members {
        for lease in &member.leases {
            let since = lease.running.map(|running| now.saturating_sub(running));
            if since.is_some_and(|since| since > lease.deadline.saturating_mul(PATIENCE) + GRACE) {
                overdue.push((*worker, lease.attempt, lease.deadline));
            }
        }
    }
    for (worker, attempt, deadline) in overdue {
        core.send(worker, ToWorker::Cancel(attempt));
        let limit_ms = u64::try_from(deadline.as_millis()).unwrap_or(u64::MAX);
        release(core, worker, attempt.job, Use::Overdue);
        let failure = Failure::Deadline { limit_ms };
        result::failed(core, worker, attempt.job, failure, now);
    }
}
