//! Leases of jobs to workers: granting, releasing, requeueing, and adopting attempts dispatched by an earlier
//! coordinator process.
use super::{
    member::Lease,
    slot_time::AttemptUse,
    state::{Core, millis},
};
use protocol::{
    id::{AttemptId, JobId, WorkerId},
    job::Job,
    message::{Assignment, Attempt, ToWorker},
};
use std::time::Duration;

/// Leases a job to a worker and queues the order to be sent.
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
        attempt: AttemptId::new(core.options.epoch, pending.next),
    };
    if !pending.holders.is_empty() {
        core.counts.copies += 1;
    } else if pending.next > 0 {
        core.counts.repeated += 1;
    }
    pending.next += 1;
    pending.holders.push(worker);
    member.runs_quarantined_job |= alone;
    member.add_lease(Lease::new(attempt, deadline, now), &core.clocks);
    let order = order(attempt, deadline, &pending.job);
    core.send(worker, order);
}

/// Builds the message that orders a worker to run a job.
pub(super) fn order(attempt: Attempt, deadline: Duration, job: &Job) -> ToWorker {
    ToWorker::Run(Box::new(Assignment {
        attempt,
        deadline_ms: millis(deadline),
        job: job.clone(),
    }))
}

/// Ends a worker's lease, books its slot time under the given use, and requeues the job unless another worker
/// holds it.
pub(super) fn release(core: &mut Core, worker: WorkerId, job: JobId, what: AttemptUse) {
    if let Some(member) = core.members.get_mut(&worker)
        && let Some(lease) = member.drop_lease(job, &core.clocks)
    {
        member.attribute(&lease, what);
    }
    requeue(core, worker, job);
}

/// Cancels the attempt of a worker at a job that is not pending any more, and books its slot time as speculative;
/// returns the attempt, if the worker had one.
pub(super) fn cancel(core: &mut Core, worker: WorkerId, job: JobId) -> Option<Attempt> {
    let member = core.members.get_mut(&worker)?;
    let lease = member.drop_lease(job, &core.clocks)?;
    member.attribute(&lease, AttemptUse::Speculative);
    core.send(worker, ToWorker::Cancel(lease.attempt));
    Some(lease.attempt)
}

/// Takes a job from a worker that may have begun it: cancels the attempt, books its slot time under the given
/// use and requeues the job.
pub(super) fn revoke(
    core: &mut Core,
    worker: WorkerId,
    attempt: Attempt,
    (what, now): (AttemptUse, Duration),
) {
    core.send(worker, ToWorker::Cancel(attempt));
    if let Some(member) = core.members.get_mut(&worker) {
        member.revoked.push((attempt, now));
    }
    release(core, worker, attempt.job, what);
}

/// Removes a worker from the holders of a job and requeues the job if no other worker holds it.
pub(super) fn requeue(core: &mut Core, worker: WorkerId, job: JobId) {
    if let Some(pending) = core.jobs.get_mut(&job) {
        pending.holders.retain(|holder| *holder != worker);
        if pending.holders.is_empty() && core.anticipated.contains(&job) {
            // a job that was taken from the worker before may wait already
            if !core.anticipated_queue.contains(&job) {
                core.anticipated_queue.push_front(job);
            }
        } else if pending.holders.is_empty() {
            core.queue.insert(job);
        }
    }
}

/// Registers a queued job as leased to a worker that reports already holding an attempt of the job,
/// dispatched by an earlier coordinator process.
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
