//! Who takes part, and who is lost.
use super::{
    admission_rules::shown,
    lease::requeue,
    notice::Notice,
    result,
    roster::{dismiss, remove},
    state::{Core, millis},
};
use protocol::{
    id::{JobId, WorkerId},
    job::Failure,
    message::ToWorker,
};
use std::{collections::BTreeSet, time::Duration};

/// Whether everyone is there who may hold jobs and results of the last process, or was waited for.
pub(super) fn is_complete(core: &mut Core, now: Duration) -> bool {
    if core.rejoining.is_none() && !core.options.expected.is_empty() {
        core.rejoining = Some(now + core.options.policy.rejoin_grace);
    }
    core.rejoining.is_none_or(|until| {
        let over = now >= until;
        if over {
            core.options.expected.clear();
            core.rejoining = None;
        }
        over
    })
}

/// One of those who were waited for is back and has said what it holds.
pub(super) fn welcome(core: &mut Core, worker: WorkerId, now: Duration) {
    if core.options.expected.remove(&worker)
        && core.options.expected.is_empty()
        && let Some(until) = core.rejoining
    {
        core.rejoining = Some(until.min(now + core.options.policy.delivery_grace));
    }
}

/// A worker leaves in good order.
pub(super) fn leave(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let reason = shown(reason);
    if dismiss(core, worker, &reason, now).is_none() {
        return;
    }
    // it waits for this, lest the end of its connection be heard first and taken for a loss
    core.send(worker, ToWorker::Ended);
    core.notice(Notice::Left { worker, reason });
}

/// The transport lost a worker: at once if its process ended, later if it merely does not answer.
pub(super) fn gone(core: &mut Core, worker: WorkerId, now: Duration) {
    let Some(member) = core.members.get(&worker) else {
        return;
    };
    if now < core.excused {
        return;
    }
    let silent = now.saturating_sub(member.heard);
    let reason = if silent > core.options.policy.heartbeat_timeout / 2 {
        silence(silent)
    } else {
        "its connection ended: it was killed, or its machine or the network went down".to_owned()
    };
    lose(core, worker, &reason, now);
}

fn silence(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    format!("nothing was heard of it for {seconds:.0} s: it is frozen, overloaded or cut off")
}

/// Gives up a worker and offers what it held to others.
///
/// Whatever it held may be to blame, even what waited there when it was last heard of: the results
/// before it may have been lost with the worker. So may what was taken from it and not yet let go.
/// The innocent clear themselves by running alone.
fn lose(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
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
    let taken = member.taken.iter().map(|(attempt, _)| attempt.job);
    let jobs: BTreeSet<JobId> = held.chain(taken).collect();
    let workers = core.options.policy.alone_after_losses;
    let mut suspects = Vec::new();
    for job in jobs {
        requeue(core, worker, job);
        let Some(pending) = core.jobs.get(&job) else {
            continue;
        };
        let losses = pending.failures.losses + 1;
        result::failed(core, worker, job, Failure::Lost { workers: losses }, now);
        if losses == workers && core.jobs.contains_key(&job) {
            suspects.push(job);
        }
    }
    if !suspects.is_empty() {
        core.suspects.extend(&suspects);
        let jobs = suspects;
        core.notice(Notice::Quarantined { jobs, workers });
    }
}

/// Gives up workers that have not spoken for too long.
pub(super) fn check_silence(core: &mut Core, now: Duration) {
    let (timeout, excused) = (core.options.policy.heartbeat_timeout, core.excused);
    let silent: Vec<WorkerId> = core
        .members
        .iter()
        .filter(|(_, member)| now.saturating_sub(member.heard.max(excused)) > timeout)
        .map(|(id, _)| *id)
        .collect();
    for worker in silent {
        lose(core, worker, &silence(timeout), now);
    }
}

/// If nobody called for a while, messages wait to be read: no worker is to blame for it.
pub(super) fn forgive_stall(core: &mut Core, now: Duration) {
    let gap = now.saturating_sub(core.last_call);
    core.last_call = now;
    if gap <= core.options.policy.stall_after || core.members.is_empty() {
        return;
    }
    for member in core.members.values_mut() {
        member.heard = (member.heard + gap).min(now);
        for lease in &mut member.leases {
            lease.sent = (lease.sent + gap).min(now);
            lease.running = lease.running.map(|running| (running + gap).min(now));
        }
    }
    excuse(core, gap, now);
}

/// This process did not answer for a while: workers that gave up their connections to it are not
/// lost, they come back.
pub(super) fn excuse(core: &mut Core, time: Duration, now: Duration) {
    let policy = &core.options.policy;
    if time >= policy.disconnecting_stall {
        core.excused = now + policy.reconnect_grace;
    }
    let ms = millis(time);
    core.notice(Notice::Stalled { ms });
}

/// Tells people, once, that jobs wait and nobody is there.
pub(super) fn check_deserted(core: &mut Core, now: Duration) {
    if !core.members.is_empty() || core.queue.is_empty() {
        core.deserted_since = None;
        core.told_deserted = false;
        return;
    }
    let since = *core.deserted_since.get_or_insert(now);
    if !core.told_deserted && now.saturating_sub(since) >= core.options.policy.no_worker_notice {
        core.told_deserted = true;
        let (jobs, refused) = (core.queue.len(), core.refused.len());
        core.notice(Notice::NoWorker { jobs, refused });
    }
}
