//! Assignment of queued jobs to workers.
use super::{
    lease::lease,
    member::Member,
    state::{Core, Pending},
};
use protocol::id::{JobId, WorkerId};
use std::time::Duration;

/// Assigns queued jobs to the least loaded workers: first those that must run alone, for which a worker is kept free,
/// then the others, lowest id first, and at last those that wait for a new worker, which they may end.
pub(super) fn assign(core: &mut Core, now: Duration) {
    let alone = core.suspects.intersection(&core.queue).copied();
    let (waiting, alone): (Vec<JobId>, Vec<JobId>) =
        alone.partition(|job| core.awaits_new_worker(*job));
    assign_each(core, alone, now);
    assign_others(core, now);
    if core.queued_jobs() == 0 {
        assign_each(core, waiting, now);
    }
}

fn assign_each(core: &mut Core, jobs: Vec<JobId>, now: Duration) {
    for job in jobs {
        if let Some(worker) = pick(core, job) {
            core.queue.remove(&job);
            lease(core, worker, job, now);
        }
    }
}

/// Assigns queued jobs that need not run alone.
fn assign_others(core: &mut Core, now: Duration) {
    let mut passed_over = Vec::new();
    while let Some(job) = core.queue.pop_first() {
        if core.suspects.contains(&job) {
            passed_over.push(job);
            continue;
        }
        if let Some(worker) = pick(core, job) {
            lease(core, worker, job, now);
        } else {
            let Some(pending) = core.jobs.get(&job) else {
                continue;
            };
            // a job that only some workers may have must not hold up the others
            let special = !pending.refused_by.is_empty() || !pending.failed_at.is_empty();
            passed_over.push(job);
            if !special {
                break;
            }
        }
    }
    core.queue.extend(passed_over);
}

/// Returns the least loaded worker that may be given a job; `None` if there is none.
fn pick(core: &Core, job: JobId) -> Option<WorkerId> {
    let pending = core.jobs.get(&job)?;
    let policy = &core.options.policy;
    let alone = core.must_run_alone(pending);
    let reserved = if alone { None } else { reserved(core) };
    let kind = pending.job.kind();
    let ahead = core.times.needs_prefetch(kind, core.latency, policy);
    let room = |member: &Member| match (alone, ahead) {
        (true, _) => 1,
        (false, true) => policy.jobs_per_slot * member.slots(),
        (false, false) => member.slots(),
    };
    core.members
        .iter()
        .filter(|(id, member)| {
            member.takes_jobs()
                && member.leases.len() < room(member)
                && reserved != Some(**id)
                && may_have(core, pending, **id)
                && (!alone || member.revoked.is_empty())
        })
        .min_by_key(|(_, member)| member.leases.len() * 4096 / member.slots())
        .map(|(id, _)| *id)
}

/// Returns whether a worker may be given a job: never if it refused the job, or joined before the last of many
/// losses of workers that held it; if it crashed or exceeded its deadline on the job, only while no other worker
/// is left to try.
pub(super) fn may_have(core: &Core, pending: &Pending, worker: WorkerId) -> bool {
    let failures = &pending.failures;
    let is_new = core
        .members
        .get(&worker)
        .is_some_and(|member| member.joined_at >= failures.last_loss);
    if failures.awaits_new_worker(&core.options.policy) && !is_new {
        return false;
    }
    let refused = |id: &WorkerId| pending.refused_by.contains(id);
    let failed = |id: &WorkerId| pending.failed_at.contains(id);
    let mut others = core.members.iter();
    !refused(&worker)
        && (!failed(&worker)
            || !others.any(|(id, member)| member.takes_jobs() && !refused(id) && !failed(id)))
}

/// Returns the worker with the largest share of idle slots among those that satisfy a condition.
pub(super) fn most_idle(core: &Core, suits: impl Fn(WorkerId) -> bool) -> Option<WorkerId> {
    let all = core.members.iter().filter(|(id, _)| suits(**id));
    let free = all.filter(|(_, member)| member.takes_jobs());
    let most = free.max_by_key(|(_, member)| member.idle() * 4096 / member.slots());
    most.filter(|(_, member)| member.idle() > 0)
        .map(|(id, _)| *id)
}

/// Returns the worker reserved for the first queued job that must run alone and that a worker may have: the
/// least loaded such worker, which gets no new jobs meanwhile.
pub(super) fn reserved(core: &Core) -> Option<WorkerId> {
    let waiting = core.suspects.iter().filter_map(|job| {
        // one that is only anticipated runs nowhere, and one that waits for a new worker comes last
        let pending = core.jobs.get(job)?;
        let is_queued = pending.holders.is_empty() && !core.anticipated.contains(job);
        (is_queued && !core.awaits_new_worker(*job)).then_some(pending)
    });
    let mut workers = waiting.filter_map(|job| {
        let ready = core
            .members
            .iter()
            .filter(|(id, member)| member.takes_jobs() && may_have(core, job, **id));
        ready.min_by_key(|(_, member)| member.leases.len())
    });
    workers.next().map(|(id, _)| *id)
}
