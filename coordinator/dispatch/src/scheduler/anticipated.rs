//! Anticipated jobs: jobs that the run will probably request, computed by slots that would be idle.
//!
//! They give way to requested jobs at once. An anticipated job is either claimed, from then on a requested
//! job, or withdrawn.
use super::{
    assign::{may_have, most_idle},
    lease::{cancel, lease, revoke},
    member::Member,
    result,
    slot_time::AttemptUse,
    state::{Core, Pending},
};
use protocol::{
    id::{JobId, WorkerId},
    job::Job,
    message::Attempt,
};
use std::{mem, time::Duration};

/// Adds an anticipated job behind those already waiting.
pub(super) fn anticipate(core: &mut Core, id: JobId, job: Job) {
    if core.has_finished(id) || core.jobs.contains_key(&id) {
        return;
    }
    core.jobs.insert(id, Pending::new(job));
    core.anticipated.insert(id);
    core.anticipated_queue.push_back(id);
}

/// Makes anticipated jobs requested ones; the slot time of those already computed becomes useful.
pub(super) fn claim(core: &mut Core, jobs: Vec<JobId>) {
    for job in jobs {
        core.anticipated.remove(&job);
        if let Some(at) = core.anticipated_queue.iter().position(|own| *own == job) {
            core.anticipated_queue.remove(at);
            core.queue.insert(job);
        }
        // the account of a worker that has left is in the journal already
        if let Some((worker, time)) = core.computed_ahead.remove(&job)
            && let Some(member) = core.members.get_mut(&worker)
        {
            member.claim(time);
        }
    }
}

/// Withdraws anticipated jobs: cancels their attempts and drops their results.
pub(super) fn withdraw(core: &mut Core, jobs: Vec<JobId>, now: Duration) {
    for job in &jobs {
        core.computed_ahead.remove(job);
        let Some(pending) = core.forget(*job) else {
            continue;
        };
        for holder in pending.holders {
            if let Some(attempt) = cancel(core, holder, *job)
                && let Some(member) = core.members.get_mut(&holder)
            {
                member.revoked.push((attempt, now));
            }
        }
    }
    // acknowledged as if stored, so that workers forget the results that they still hold
    result::stored(core, jobs);
}

/// Gives idle slots anticipated jobs, in their order, if no requested job waits.
pub(super) fn assign(core: &mut Core, now: Duration) {
    if core.anticipated_queue.is_empty() || core.queued_jobs() > 0 {
        return;
    }
    let mut left = mem::take(&mut core.anticipated_queue);
    left.retain(|&job| {
        let Some(pending) = core.jobs.get(&job) else {
            return false;
        };
        // one that may end its worker is computed only if it is requested
        let suits = |id: WorkerId| !core.must_run_alone(pending) && may_have(core, pending, id);
        let idle = most_idle(core, suits);
        if let Some(worker) = idle {
            lease(core, worker, job, now);
        }
        idle.is_none()
    });
    core.anticipated_queue = left;
}

/// Takes anticipated jobs from their workers until at least `wanted` slots are idle.
pub(super) fn make_room(core: &mut Core, wanted: usize, now: Duration) {
    if wanted == 0 || core.anticipated.len() == core.anticipated_queue.len() {
        return;
    }
    let ready = core.members.values().filter(|member| member.takes_jobs());
    let idle: usize = ready.map(Member::idle).sum();
    for (worker, attempt) in held(core, wanted.saturating_sub(idle)) {
        revoke(core, worker, attempt, (AttemptUse::Speculative, now));
    }
}

/// Returns up to `most` attempts of anticipated jobs, with the workers that hold them.
fn held(core: &Core, most: usize) -> Vec<(WorkerId, Attempt)> {
    let members = core.members.iter();
    let leases =
        members.flat_map(|(id, member)| member.leases.iter().map(|own| (*id, own.attempt)));
    let anticipated = leases.filter(|(_, attempt)| core.anticipated.contains(&attempt.job));
    anticipated.take(most).collect()
}
