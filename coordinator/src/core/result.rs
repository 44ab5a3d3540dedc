//! What becomes of results and failures.
use super::{
    Core,
    account::{self, Use},
    assign,
    input::Command,
    notice::{Notice, Stop},
    reconcile,
};
use protocol::{
    event::Finished,
    id::{JobId, WorkerId},
    job::{Failure, Outcome},
    message::{Attempt, Done, ToWorker},
};
use std::time::Duration;

/// A worker brought a result.
pub(super) fn done(core: &mut Core, from: WorkerId, done: Done, now: Duration) {
    let job = done.attempt.job;
    if let Some(member) = core.members.get_mut(&from) {
        member.taken.retain(|(attempt, _)| *attempt != done.attempt);
    }
    if let Some(waiting) = core.storing.get_mut(&job) {
        if !waiting.contains(&(from, done.attempt)) {
            waiting.push((from, done.attempt));
        }
        core.counts.duplicates += 1;
        return;
    }
    if core.finished.contains(job) {
        core.send(from, ToWorker::Stored(vec![done.attempt]));
        core.counts.duplicates += 1;
        return;
    }
    let Some(pending) = core.jobs.get(&job) else {
        // nothing of strangers is kept, unless they may be workers of an earlier process
        if core.members.contains_key(&from)
            || core.options.expected.contains(&from)
            || core.options.epoch > 1
        {
            core.early.put(from, done);
        }
        return;
    };
    let held = core.members.get(&from).is_some_and(|member| {
        let mut leases = member.leases.iter();
        leases.any(|lease| lease.attempt == done.attempt)
    });
    let (wall_us, kind) = (done.wall_us, pending.job.kind());
    let failure = if pending.work == done.work {
        match done.outcome {
            Outcome::Failed(failure) => failure,
            outcome @ (Outcome::Scored(_)
            | Outcome::Simulated(_)
            | Outcome::Observed(_)
            | Outcome::Described(_)
            | Outcome::HeadReduced(_)
            | Outcome::Nothing(_)) => {
                if let Some(member) = core.members.get_mut(&from) {
                    member.done += 1;
                }
                core.times.add(kind, wall_us, &core.options.policy);
                core.counts.succeeded += 1;
                accept(core, Some(from), Done { outcome, ..done });
                return;
            }
        }
    } else if held {
        // it was given this job and did another: it reads jobs in another way than we do
        Failure::Refused {
            reason: format!(
                "it answered for the work {} when it was given {}; use the same build of \
                 horsehead-worker on every machine",
                done.work, pending.work
            ),
        }
    } else {
        // an answer to another question, of another run: forget it
        core.send(from, ToWorker::Stored(vec![done.attempt]));
        return;
    };
    core.send(from, ToWorker::Stored(vec![done.attempt]));
    if let Some(member) = core.members.get_mut(&from) {
        member.failed += 1;
    }
    // a failure of an attempt that was taken away says nothing about the job
    if held {
        assign::release(core, from, job, Use::Failed(wall_us));
        failed(core, from, job, failure, now);
    }
}

/// The one result of a job: stored, delivered, and no longer wanted from anyone else.
fn accept(core: &mut Core, from: Option<WorkerId>, done: Done) {
    let job = done.attempt.job;
    let Some(pending) = core.jobs.remove(&job) else {
        return;
    };
    core.queue.remove(&job);
    core.suspects.remove(&job);
    for holder in pending.holders {
        let Some(member) = core.members.get_mut(&holder) else {
            continue;
        };
        let Some(lease) = member.drop_lease(job, &core.clocks) else {
            continue;
        };
        if Some(holder) == from {
            if lease.prompt {
                let fresh = lease
                    .held
                    .saturating_sub(Duration::from_micros(done.wall_us));
                let before = core.latency.unwrap_or(fresh);
                core.latency = Some((before * 7 + fresh) / 8);
            }
            account::attribute(member, &lease, Use::Useful(done.wall_us));
        } else {
            account::attribute(member, &lease, Use::Speculative);
            core.send(holder, ToWorker::Cancel(lease.attempt));
        }
    }
    core.storing.insert(
        job,
        from.map(|from| (from, done.attempt)).into_iter().collect(),
    );
    core.out.push(Command::Deliver {
        id: job,
        outcome: done.outcome.clone(),
    });
    core.out.push(Command::Store(Box::new(Finished {
        attempt: done.attempt,
        work: done.work,
        worker: from,
        wall_us: done.wall_us,
        outcome: done.outcome,
    })));
}

/// Results became safe: the workers may forget them.
pub(super) fn stored(core: &mut Core, jobs: Vec<JobId>) {
    let mut acknowledged: std::collections::BTreeMap<WorkerId, Vec<Attempt>> =
        std::collections::BTreeMap::new();
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

/// An attempt failed, whose worker no longer holds it: try again, or give the job up.
pub(super) fn failed(
    core: &mut Core,
    worker: WorkerId,
    job: JobId,
    failure: Failure,
    now: Duration,
) {
    let policy = &core.options.policy;
    let Some(pending) = core.jobs.get_mut(&job) else {
        return;
    };
    let mut again = pending.failures.count(&failure, policy);
    if let Failure::Refused { .. } = failure {
        pending.refused_by.insert(worker);
        let refused_by = &pending.refused_by;
        again = core
            .members
            .keys()
            .any(|member| !refused_by.contains(member));
    }
    if !again {
        give_up(core, job, failure);
    }
    reconcile::adopt(core, job, now);
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
    if core.counts.succeeded == 0 && core.counts.failed == core.options.policy.hopeless {
        let (jobs, last) = (core.counts.failed, failure.clone());
        core.out
            .push(Command::Stop(Stop::EverythingFails { jobs, last }));
    }
    let attempt = Attempt {
        job,
        attempt: assign::STATED,
    };
    let done = Done {
        attempt,
        work,
        wall_us: 0,
        outcome: Outcome::Failed(failure),
    };
    match &done.outcome {
        // another build or another case may do better: not a result of the run
        Outcome::Failed(Failure::Refused { .. } | Failure::Misconfigured { .. }) => {
            core.jobs.remove(&job);
            core.queue.remove(&job);
            core.suspects.remove(&job);
            core.out.push(Command::Deliver {
                id: job,
                outcome: done.outcome,
            });
        }
        Outcome::Failed(_)
        | Outcome::Scored(_)
        | Outcome::Simulated(_)
        | Outcome::Observed(_)
        | Outcome::Described(_)
        | Outcome::HeadReduced(_)
        | Outcome::Nothing(_) => {
            accept(core, None, done);
        }
    }
}
