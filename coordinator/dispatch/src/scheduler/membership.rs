//! Membership of workers: return after a coordinator restart, departure, loss by a broken connection or
//! silence, and compensation of stalls of the coordinator.
use super::{
    admission_rules::sanitized,
    input::Command,
    lease::{adopt, requeue},
    notice::{Notice, StopReason},
    roster::{dismiss, remove},
    state::{Core, Phase, millis},
};
use protocol::{
    id::{JobId, WorkerId},
    message::ToWorker,
};
use std::{collections::BTreeSet, time::Duration};

/// Returns whether the wait after a coordinator restart is over: all workers that may hold jobs or results of
/// the previous process have returned, or the grace period has ended.
pub(super) fn rejoin_finished(core: &mut Core, now: Duration) -> bool {
    if core.rejoin_until.is_none() && !core.options.expected.is_empty() {
        core.rejoin_until = Some(now + core.options.policy.rejoin_grace);
    }
    core.rejoin_until.is_none_or(|until| {
        let over = now >= until;
        if over {
            core.options.expected.clear();
            core.rejoin_until = None;
        }
        over
    })
}

/// Registers the return of a worker that was expected after a coordinator restart; after the last one only
/// the grace period for the delivery of results remains.
pub(super) fn worker_returned(core: &mut Core, worker: WorkerId, now: Duration) {
    if core.options.expected.remove(&worker)
        && core.options.expected.is_empty()
        && let Some(until) = core.rejoin_until
    {
        core.rejoin_until = Some(until.min(now + core.options.policy.delivery_grace));
    }
}

/// Removes a worker that announced its departure.
pub(super) fn leave(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let reason = sanitized(reason);
    if dismiss(core, worker, &reason, now).is_none() {
        return;
    }
    // it waits for this, lest the end of its connection be heard first and taken for a loss
    core.send(worker, ToWorker::Ended);
    core.notice(Notice::Left { worker, reason });
}

/// Handles a connection loss reported by the transport: immediate if the worker's process ended, delayed if
/// it only stopped responding.
pub(super) fn connection_lost(core: &mut Core, worker: WorkerId, now: Duration) {
    let Some(member) = core.members.get(&worker) else {
        return;
    };
    if now < core.reconnect_grace_until {
        return;
    }
    let silent = now.saturating_sub(member.last_heard);
    let reason = if silent > core.options.policy.heartbeat_timeout / 2 {
        silence(silent)
    } else {
        "its connection was closed: the worker was killed, or its machine or the network failed"
            .to_owned()
    };
    declare_lost(core, worker, &reason, now);
}

fn silence(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    format!(
        "no message arrived from it for {seconds:.0} s: the worker is frozen, overloaded or disconnected"
    )
}

/// Declares a worker lost and requeues its jobs.
///
/// Every job that the worker held may have caused the loss and counts a failure: also jobs last reported as
/// waiting, since results of earlier jobs may have been lost with the worker, and jobs withdrawn from the
/// worker that it has not yet released. Innocent jobs are cleared by running alone.
fn declare_lost(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let Some(member) = remove(core, worker, reason, now) else {
        return;
    };
    core.counts.lost += 1;
    core.notice(Notice::Lost {
        worker,
        reason: reason.to_owned(),
        jobs: member.leases.len(),
    });
    let held = member.leases.iter().map(|lease| lease.attempt.job);
    let taken = member.revoked.iter().map(|(attempt, _)| attempt.job);
    let jobs: BTreeSet<JobId> = held.chain(taken).collect();
    let workers = core.options.policy.alone_after_losses;
    let mut suspects = Vec::new();
    for job in jobs {
        requeue(core, worker, job);
        let Some(pending) = core.jobs.get_mut(&job) else {
            continue;
        };
        pending.failures.count_loss(now);
        let losses = pending.failures.losses;
        if losses == workers {
            suspects.push(job);
        }
        if losses == core.options.policy.wait_after_losses && !core.anticipated.contains(&job) {
            let (worker, host) = (worker, member.announcement.host.clone());
            core.notice(Notice::AwaitsWorker {
                job,
                losses,
                worker,
                host,
                limit: core.options.policy.pause_limit,
            });
        }
        adopt(core, job, now);
    }
    if !suspects.is_empty() {
        core.suspects.extend(&suspects);
        let jobs = suspects;
        core.notice(Notice::Quarantined { jobs, workers });
    }
}

/// Stops the run once no result has come for longer than the pause limit and no job is left but those that
/// wait for a new worker because all that held them were lost.
pub(super) fn check_waiting_jobs(core: &mut Core, now: Duration) {
    let policy = &core.options.policy;
    let mut waiting = None;
    for (id, pending) in &core.jobs {
        if core.anticipated.contains(id) {
            continue;
        }
        if pending.failures.awaits_new_worker(policy) {
            waiting.get_or_insert((*id, pending.failures.losses));
        } else if !pending.holders.is_empty() {
            // the run makes progress
            core.waiting_since = None;
            return;
        }
    }
    let Some((job, workers)) = waiting.filter(|_| core.phase == Phase::Open) else {
        core.waiting_since = None;
        return;
    };
    let since = *core.waiting_since.get_or_insert(now);
    let is_held = core
        .jobs
        .get(&job)
        .is_some_and(|job| !job.holders.is_empty());
    let limit = policy.pause_limit;
    if !is_held && now.saturating_sub(since) >= limit {
        core.phase = Phase::Finishing;
        let reason = StopReason::WorkersLost {
            job,
            workers,
            limit,
        };
        core.commands.push(Command::Stop(reason));
    }
}

/// Declares workers lost that have been silent for longer than the heartbeat timeout.
pub(super) fn check_silence(core: &mut Core, now: Duration) {
    let (timeout, excused) = (
        core.options.policy.heartbeat_timeout,
        core.reconnect_grace_until,
    );
    let silent: Vec<WorkerId> = core
        .members
        .iter()
        .filter(|(_, member)| now.saturating_sub(member.last_heard.max(excused)) > timeout)
        .map(|(id, _)| *id)
        .collect();
    for worker in silent {
        declare_lost(core, worker, &silence(timeout), now);
    }
}

/// Detects that the coordinator was not called for a while, so that messages are still unread, and moves all
/// heartbeat and lease times forward by the gap.
pub(super) fn compensate_stall(core: &mut Core, now: Duration) {
    let gap = now.saturating_sub(core.last_call);
    core.last_call = now;
    if gap <= core.options.policy.stall_after || core.members.is_empty() {
        return;
    }
    for member in core.members.values_mut() {
        member.last_heard = (member.last_heard + gap).min(now);
        for lease in &mut member.leases {
            lease.sent = (lease.sent + gap).min(now);
            lease.running = lease.running.map(|running| (running + gap).min(now));
        }
    }
    start_reconnect_grace(core, gap, now);
}

/// Ignores broken connections for a grace period after a stall of the coordinator, since workers that dropped
/// their connections during the stall will reconnect and are not lost.
pub(super) fn start_reconnect_grace(core: &mut Core, time: Duration, now: Duration) {
    let policy = &core.options.policy;
    if time >= policy.disconnecting_stall {
        core.reconnect_grace_until = now + policy.reconnect_grace;
    }
    let ms = millis(time);
    core.notice(Notice::Stalled { ms });
}

/// Emits a notice, once, when jobs have waited for too long without any connected worker.
pub(super) fn check_no_workers(core: &mut Core, now: Duration) {
    if !core.members.is_empty() || core.queue.is_empty() {
        core.no_worker_since = None;
        core.no_worker_notified = false;
        return;
    }
    let since = *core.no_worker_since.get_or_insert(now);
    if !core.no_worker_notified && now.saturating_sub(since) >= core.options.policy.no_worker_notice
    {
        core.no_worker_notified = true;
        let (jobs, refused) = (core.queue.len(), core.refused.len());
        core.notice(Notice::NoWorker { jobs, refused });
    }
}
