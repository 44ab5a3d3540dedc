//! Who takes part, and who is lost.
use super::{
    Core, Phase,
    account::{self, Clocks, Use},
    admission, assign,
    input::Command,
    notice::Notice,
    policy::Failures,
    reconcile, result,
    state::Member,
};
use protocol::{
    event::{Event, WorkerAccount},
    id::{JobId, WorkerId},
    job::Failure,
    message::{Beat, FromWorker, ToWorker},
};
use std::{collections::BTreeSet, time::Duration};

pub(super) fn heard(core: &mut Core, from: WorkerId, message: FromWorker, now: Duration) {
    let known = core
        .members
        .get_mut(&from)
        .map(|member| member.heard = now)
        .is_some();
    match message {
        FromWorker::Announce(_) if core.phase == Phase::Closed => {}
        FromWorker::Announce(announcement) => admission::announce(core, from, *announcement, now),
        FromWorker::Beat(beat) if known => beaten(core, from, &beat, now),
        FromWorker::Beat(_) => core.send(from, ToWorker::Identify),
        // it differs from the others, and so may what it computes
        FromWorker::Done(_) if core.refused.contains(&from) => {}
        FromWorker::Done(done) => {
            if !known {
                core.send(from, ToWorker::Identify);
            }
            result::done(core, from, *done, now);
        }
        FromWorker::Leaving { reason } if known => leave(core, from, &reason, now),
        FromWorker::Leaving { .. } => {}
    }
}

fn beaten(core: &mut Core, from: WorkerId, beat: &Beat, now: Duration) {
    let Some(ready) = admission::is_ready(core, from, beat) else {
        return;
    };
    let unmentioned = core.options.policy.unmentioned;
    if let Some(member) = core.members.get_mut(&from) {
        if member.ready != ready {
            account::settle(member, &core.clocks);
            member.ready = ready;
        }
        for lease in &mut member.leases {
            if lease.running.is_none() && beat.running.contains(&lease.attempt) {
                lease.running = Some(now);
            }
        }
        member.claims.clear();
        member.taken.retain(|(attempt, at)| {
            let mut held = beat.running.iter().chain(&beat.waiting);
            held.any(|held| held == attempt) || now.saturating_sub(*at) < unmentioned
        });
    }
    reconcile::reconcile(core, from, beat, now);
    if beat.case.is_some() {
        welcome(core, from, now);
    }
}

/// Whether everyone is there who may hold jobs and results of the last process, or was waited for.
pub(super) fn is_complete(core: &mut Core, now: Duration) -> bool {
    let policy = &core.options.policy;
    if core.reunion.is_none() && !core.options.expected.is_empty() {
        core.reunion = Some(now + policy.reunion);
    }
    core.reunion.is_none_or(|until| {
        let over = now >= until;
        if over {
            core.options.expected.clear();
            core.reunion = None;
        }
        over
    })
}

/// One of those who were waited for is back and has said what it holds.
fn welcome(core: &mut Core, worker: WorkerId, now: Duration) {
    if core.options.expected.remove(&worker)
        && core.options.expected.is_empty()
        && let Some(until) = core.reunion
    {
        core.reunion = Some(until.min(now + core.options.policy.delivery));
    }
}

fn leave(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let reason = admission::shown(reason);
    let Some(member) = remove(core, worker, &reason, now) else {
        return;
    };
    for lease in member.leases {
        // nobody is to blame
        assign::requeue(core, worker, lease.attempt.job);
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
    let reason = if silent > core.options.policy.silence / 2 {
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
pub(super) fn lose(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let Some(member) = remove(core, worker, reason, now) else {
        return;
    };
    core.counts.lost += 1;
    let offered = member.leases.len();
    core.notice(Notice::Lost {
        worker,
        reason: reason.to_owned(),
        jobs: offered,
    });
    let held = member.leases.iter().map(|lease| lease.attempt.job);
    let taken = member.taken.iter().map(|(attempt, _)| attempt.job);
    let jobs: BTreeSet<JobId> = held.chain(taken).collect();
    let mut suspects = Vec::new();
    for job in jobs {
        assign::requeue(core, worker, job);
        let Some(pending) = core.jobs.get(&job) else {
            continue;
        };
        let losses = pending.failures.losses + 1;
        result::failed(core, worker, job, Failure::Lost { workers: losses }, now);
        if losses == core.options.policy.suspect && core.jobs.contains_key(&job) {
            suspects.push(job);
        }
    }
    if !suspects.is_empty() {
        core.suspects.extend(&suspects);
        core.notice(Notice::Quarantined {
            jobs: suspects,
            workers: core.options.policy.suspect,
        });
    }
}

/// Takes out a worker that must not take part after all; nobody is to blame for its jobs.
pub(super) fn lose_refused(core: &mut Core, worker: WorkerId) -> Option<Member> {
    let now = core.clocks.now;
    let member = remove(core, worker, "it was refused", now)?;
    for lease in &member.leases {
        assign::requeue(core, worker, lease.attempt.job);
    }
    Some(member)
}

/// Takes a worker out; what it was computing is lost.
fn remove(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) -> Option<Member> {
    let mut member = core.members.remove(&worker)?;
    account::settle(&mut member, &core.clocks);
    for lease in member.leases.clone() {
        account::attribute(&mut member, &lease, Use::Lost);
    }
    for lease in &mut member.leases {
        lease.held = Duration::ZERO;
    }
    let row = row(worker, &member, &core.clocks);
    core.counts.past.add(&row.spent);
    core.record_account(vec![row], now);
    let reason = reason.to_owned();
    core.out
        .push(Command::Record(Event::Left { worker, reason }));
    Some(member)
}

/// A worker's account until now.
pub(super) fn row(worker: WorkerId, member: &Member, clocks: &Clocks) -> WorkerAccount {
    WorkerAccount {
        worker,
        host: member.announcement.host.clone(),
        slots: member.announcement.slots,
        done: member.done,
        failed: member.failed,
        spent: account::statement(member, clocks),
    }
}

pub(super) fn check_silence(core: &mut Core, now: Duration) {
    let (silence, excused) = (core.options.policy.silence, core.excused);
    let silent: Vec<WorkerId> = core
        .members
        .iter()
        .filter(|(_, member)| now.saturating_sub(member.heard.max(excused)) > silence)
        .map(|(id, _)| *id)
        .collect();
    for worker in silent {
        lose(core, worker, &self::silence(silence), now);
    }
}

/// If nobody called for a while, messages wait to be read: no worker is to blame for it.
pub(super) fn forgive_stall(core: &mut Core, now: Duration) {
    let gap = now.saturating_sub(core.last_call);
    core.last_call = now;
    if gap <= core.options.policy.stall || core.members.is_empty() {
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
    if time >= policy.estranged {
        core.excused = now + policy.return_within;
    }
    let ms = u64::try_from(time.as_millis()).unwrap_or(u64::MAX);
    core.notice(Notice::Stalled { ms });
}

/// Tells people, once, that jobs wait and nobody is there.
pub(super) fn check_lonely(core: &mut Core, now: Duration) {
    if !core.members.is_empty() || core.queue.is_empty() {
        core.lonely_since = None;
        core.told_lonely = false;
        return;
    }
    let since = *core.lonely_since.get_or_insert(now);
    if !core.told_lonely && now.saturating_sub(since) >= core.options.policy.lonely {
        core.told_lonely = true;
        let (jobs, refused) = (core.queue.len(), core.refused.len());
        core.notice(Notice::NoWorker { jobs, refused });
    }
}

/// Whether a job must run alone.
pub(super) const fn is_suspect(failures: Failures, suspect: u32) -> bool {
    failures.losses >= suspect
}
