//! Draining of workers: they get no new jobs, finish or return their current jobs, and stay idle or end.
use super::{
    input::Drain, lease::revoke, member::Member, notice::Notice, roster::dismiss,
    slot_time::AttemptUse, state::Core,
};
use protocol::{
    id::WorkerId,
    message::{Attempt, ToWorker},
};
use std::time::Duration;

/// Drains a worker; with `how.now` its jobs are cancelled and queued again.
pub(super) fn drain(core: &mut Core, worker: WorkerId, how: Drain, now: Duration) {
    let Some(member) = core.members.get_mut(&worker) else {
        return;
    };
    member.drained = true;
    core.drained.insert(worker, how);
    if how.now {
        let held: Vec<Attempt> = member.leases.iter().map(|lease| lease.attempt).collect();
        for attempt in held {
            revoke(core, worker, attempt, (AttemptUse::Lost, now));
        }
    }
}

/// Sends the order to end to drained workers whose drain requested it and that hold no job.
pub(super) fn end_drained(core: &mut Core, now: Duration) {
    let ends = |(worker, how): (&WorkerId, &Drain)| how.end.then_some(*worker);
    let ending: Vec<WorkerId> = core.drained.iter().filter_map(ends).collect();
    for worker in ending {
        let holds = |member: &Member| !member.leases.is_empty();
        if core.members.get(&worker).is_none_or(holds) {
            continue;
        }
        let reason = "it was asked to end";
        if dismiss(core, worker, reason, now).is_some() {
            turn_away(core, worker);
            let reason = reason.to_owned();
            core.notice(Notice::Left { worker, reason });
        }
    }
}

/// Sends a worker the order to end, if a drain requested that the worker end, and returns whether the order
/// was sent. The message may be lost; the worker then announces itself again.
pub(super) fn turn_away(core: &mut Core, worker: WorkerId) -> bool {
    let ends = core.drained.get(&worker).is_some_and(|how| how.end);
    if ends {
        let reason = "it was asked to end by `horsehead workers down`".to_owned();
        core.send(worker, ToWorker::Refused { reason });
    }
    ends
}
