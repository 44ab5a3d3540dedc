//! Who holds which job: given, taken back, adopted from an earlier process.
use super::{
    member::Lease,
    slot_time::Use,
    state::{Core, millis},
};
use protocol::{
    id::{AttemptId, JobId, WorkerId},
    job::Job,
    message::{Attempt, Order, ToWorker},
};
use std::time::Duration;

/// The attempt of a failure that the coordinator states itself.
pub(super) const STATED: AttemptId = AttemptId(u32::MAX);

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
    let Some(pending) = core.jobs.get(&job) else {
        return;
    };
    let (deadline, alone) = (core.deadline(pending), core.must_run_alone(pending));
    let (Some(member), Some(pending)) = (core.members.get_mut(&worker), core.jobs.get_mut(&job))
    else {
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
    member.alone |= alone;
    member.add_lease(Lease::new(attempt, deadline, now), &core.clocks);
    let order = order(attempt, deadline, &pending.job);
    core.send(worker, order);
}

/// What tells a worker to do a job.
pub(super) fn order(attempt: Attempt, deadline: Duration, job: &Job) -> ToWorker {
    ToWorker::Run(Box::new(Order {
        attempt,
        deadline_ms: millis(deadline),
        job: job.clone(),
    }))
}

/// Takes a job from a worker and puts it back into the queue, unless someone else has it too.
pub(super) fn release(core: &mut Core, worker: WorkerId, job: JobId, what: Use) {
    if let Some(member) = core.members.get_mut(&worker)
        && let Some(lease) = member.drop_lease(job, &core.clocks)
    {
        member.attribute(&lease, what);
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
    let (Some((worker, attempt)), Some(pending)) = (claim, core.jobs.get(&job)) else {
        return;
    };
    let deadline = core.deadline(pending);
    let (Some(member), Some(pending)) = (core.members.get_mut(&worker), core.jobs.get_mut(&job))
    else {
        return;
    };
    member.claims.retain(|claim| *claim != attempt);
    member.add_lease(Lease::new(attempt, deadline, now), &core.clocks);
    pending.holders.push(worker);
    core.queue.remove(&job);
}
