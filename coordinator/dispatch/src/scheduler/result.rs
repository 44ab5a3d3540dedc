//! Handling of the results and failures of jobs: acceptance, delivery, acknowledgement, retry and
//! abandonment.
use super::{
    completed::Completed,
    input::Command,
    lease::{adopt, cancel, release},
    notice::{Notice, StopReason},
    slot_time::AttemptUse,
    state::{Core, Pending, millis},
};
use journal::event::Finished;
use protocol::{
    id::{AttemptId, JobId, WorkerId},
    job::{Failure, Outcome},
    message::{Attempt, Cost, Done, ToWorker},
};
use std::{collections::BTreeMap, time::Duration};

/// Multiple of an attempt's deadline after which the coordinator ends the attempt itself; large, because the
/// worker, which enforces the deadline, does not count the time for which a job got no processor.
const OVERDUE_FACTOR: u32 = 8;
/// Additional time beyond `OVERDUE_FACTOR` times the deadline that the coordinator gives the worker to report
/// an overdue attempt as ended, before it ends the attempt itself.
const GRACE: Duration = Duration::from_secs(10);

/// Handles a result or failure delivered by a worker.
pub(super) fn done(core: &mut Core, from: WorkerId, done: Done, now: Duration) {
    let job = done.attempt.job;
    if let Some(member) = core.members.get_mut(&from) {
        member
            .revoked
            .retain(|(attempt, _)| *attempt != done.attempt);
    }
    if is_duplicate(core, from, done.attempt) {
        return;
    }
    let Some(pending) = core.jobs.get(&job) else {
        if core.is_orphan(job) {
            core.unclaimed.take(job);
            core.send(from, ToWorker::Stored(vec![done.attempt]));
            return;
        }
        // nothing of strangers is kept, unless they may be workers of an earlier process
        if core.members.contains_key(&from)
            || core.options.expected.contains(&from)
            || core.options.epoch > 1
        {
            core.unclaimed.put(from, done);
        }
        return;
    };
    let held = core.members.get(&from).is_some_and(|member| {
        let mut leases = member.leases.iter();
        leases.any(|lease| lease.attempt == done.attempt)
    });
    let (attempt, wall_us, kind) = (done.attempt, done.cost.wall_us, pending.job.kind());
    let failure = if let Some(failure) = work_mismatch(pending, &done) {
        if !held {
            // an answer to another question, of another run: forget it
            core.send(from, ToWorker::Stored(vec![done.attempt]));
            return;
        }
        failure
    } else if let Outcome::Failed(failure) = done.outcome {
        failure
    } else {
        if let Some(member) = core.members.get_mut(&from) {
            member.done += 1;
        }
        core.times.add(kind, wall_us, &core.options.policy);
        core.counts.succeeded += 1;
        core.waiting_since = None;
        accept(core, Some(from), done);
        return;
    };
    core.send(from, ToWorker::Stored(vec![done.attempt]));
    if let Some(member) = core.members.get_mut(&from) {
        member.failed += 1;
    }
    // a failure of an attempt that was taken away says nothing about the job
    if held {
        release(core, from, job, AttemptUse::Failed(wall_us));
        // a heartbeat from before the failure must not bring the attempt back
        if let Some(member) = core.members.get_mut(&from) {
            member.revoked.push((attempt, now));
        }
        failed(core, from, job, failure, now);
    }
}

/// Returns whether the job of a delivered attempt already has a result; if so, acknowledges the attempt now
/// or once the accepted result is stored.
fn is_duplicate(core: &mut Core, from: WorkerId, attempt: Attempt) -> bool {
    if let Some(waiting) = core.storing.get_mut(&attempt.job) {
        if !waiting.contains(&(from, attempt)) {
            waiting.push((from, attempt));
        }
    } else if core.finished.contains(attempt.job) {
        core.send(from, ToWorker::Stored(vec![attempt]));
    } else {
        return false;
    }
    core.counts.duplicates += 1;
    true
}

/// Returns a failure if a worker's result carries another hash of the job's content than the job it was sent,
/// that is, if the worker decodes jobs differently from this build.
fn work_mismatch(pending: &Pending, done: &Done) -> Option<Failure> {
    (pending.work != done.work).then(|| Failure::Refused {
        reason: format!(
            "the worker returned a result for work {} but was sent work {}; use the same build of \
             horsehead-worker on every machine",
            done.work, pending.work
        ),
    })
}

/// Accepts the result of a job: stores and delivers it, and cancels the attempts of other workers.
fn accept(core: &mut Core, from: Option<WorkerId>, done: Done) {
    let job = done.attempt.job;
    let anticipated = core.anticipated.contains(&job);
    let Some(pending) = core.forget(job) else {
        return;
    };
    for holder in pending.holders {
        if Some(holder) != from {
            cancel(core, holder, job);
            continue;
        }
        let Some(member) = core.members.get_mut(&holder) else {
            continue;
        };
        let Some(lease) = member.drop_lease(job, &core.clocks) else {
            continue;
        };
        if lease.sent_to_idle_slot {
            let wall = Duration::from_micros(done.cost.wall_us);
            let fresh = lease.held.saturating_sub(wall);
            let before = core.latency.unwrap_or(fresh);
            core.latency = Some((before * 7 + fresh) / 8);
        }
        if anticipated {
            let spent = member.attribute(&lease, AttemptUse::Ahead(done.cost.wall_us));
            core.computed_ahead.insert(job, (holder, spent));
        } else {
            member.attribute(&lease, AttemptUse::Useful(done.cost.wall_us));
        }
    }
    let waiting = from.map(|from| (from, done.attempt));
    core.storing.insert(job, waiting.into_iter().collect());
    deliver(core, job, done.cost, done.outcome.clone());
    core.commands.push(Command::Store(Box::new(Finished {
        attempt: done.attempt,
        work: done.work,
        worker: from,
        cost: done.cost,
        outcome: done.outcome,
    })));
}

fn deliver(core: &mut Core, id: JobId, cost: Cost, outcome: Outcome) {
    core.commands.push(Command::Deliver(Completed {
        id,
        cost,
        outcome,
        replayed: false,
    }));
}

/// Marks results as stored in the journal and acknowledges them to the workers that delivered them.
pub(super) fn stored(core: &mut Core, jobs: Vec<JobId>) {
    let mut acknowledged: BTreeMap<WorkerId, Vec<Attempt>> = BTreeMap::new();
    for job in jobs {
        for (worker, attempt) in core.storing.remove(&job).unwrap_or_default() {
            acknowledged.entry(worker).or_default().push(attempt);
        }
        core.finished.insert(job);
    }
    for (worker, attempts) in acknowledged {
        core.send(worker, ToWorker::Stored(attempts));
    }
}

/// Ends attempts that are long past the deadline their worker should have enforced.
pub(super) fn check_overdue(core: &mut Core, now: Duration) {
    let mut overdue = Vec::new();
    for (worker, member) in &core.members {
        for lease in &member.leases {
            let since = lease.running.map(|running| now.saturating_sub(running));
            if since
                .is_some_and(|since| since > lease.deadline.saturating_mul(OVERDUE_FACTOR) + GRACE)
            {
                overdue.push((*worker, lease.attempt, lease.deadline));
            }
        }
    }
    for (worker, attempt, deadline) in overdue {
        core.send(worker, ToWorker::Cancel(attempt));
        release(core, worker, attempt.job, AttemptUse::Overdue);
        let limit_ms = millis(deadline);
        let failure = Failure::deadline(limit_ms);
        failed(core, worker, attempt.job, failure, now);
    }
}

/// Counts the failure of an attempt whose worker no longer holds it, and retries the job or gives it up.
pub(super) fn failed(
    core: &mut Core,
    worker: WorkerId,
    job: JobId,
    failure: Failure,
    now: Duration,
) {
    let Some(pending) = core.jobs.get_mut(&job) else {
        return;
    };
    let mut again = pending.failures.count(&failure, &core.options.policy);
    match failure {
        Failure::Refused { .. } => {
            pending.refused_by.insert(worker);
            let refused_by = &pending.refused_by;
            let mut members = core.members.keys();
            again = members.any(|member| !refused_by.contains(member));
        }
        Failure::Crashed { .. } | Failure::Deadline { .. } => {
            pending.failed_at.insert(worker);
        }
        Failure::Lost { .. } | Failure::Misconfigured { .. } => {}
    }
    if !again {
        give_up(core, job, failure);
    }
    adopt(core, job, now);
}

fn give_up(core: &mut Core, job: JobId, failure: Failure) {
    let Some(work) = core.jobs.get(&job).map(|pending| pending.work) else {
        return;
    };
    core.counts.failed += 1;
    core.notice(Notice::GivenUp {
        job,
        failure: failure.clone(),
    });
    if core.counts.succeeded == 0 && core.counts.failed == core.options.policy.stop_after_failures {
        let (jobs, last) = (core.counts.failed, failure.clone());
        core.commands
            .push(Command::Stop(StopReason::EverythingFails { jobs, last }));
    }
    let (cost, attempt) = (Cost::default(), AttemptId::COORDINATOR);
    match failure {
        // another build or another case may do better: not a result of the run
        Failure::Refused { .. } | Failure::Misconfigured { .. } | Failure::Lost { .. } => {
            let holders = core.forget(job).map(|own| own.holders);
            for holder in holders.into_iter().flatten() {
                cancel(core, holder, job);
            }
            deliver(core, job, cost, Outcome::Failed(failure));
        }
        Failure::Deadline { .. } | Failure::Crashed { .. } => {
            let done = Done {
                attempt: Attempt { job, attempt },
                work,
                cost,
                outcome: Outcome::Failed(failure),
            };
            accept(core, None, done);
        }
    }
}
