//! Taking workers out of the run.
use super::{lease::requeue, member::Member, state::Core};
use protocol::{event::Event, id::WorkerId};
use std::time::Duration;

/// Takes a worker out; what it was computing is lost.
pub(super) fn remove(
    core: &mut Core,
    worker: WorkerId,
    reason: &str,
    now: Duration,
) -> Option<Member> {
    let mut member = core.members.remove(&worker)?;
    member.lose_leases(&core.clocks);
    let row = member.row(worker, &core.clocks);
    core.counts.past.add(&row.spent);
    core.record_account(vec![row], now);
    let reason = reason.to_owned();
    core.record(Event::Left { worker, reason });
    Some(member)
}

/// Takes out a worker that is not to blame for anything: what it held waits for others.
pub(super) fn dismiss(
    core: &mut Core,
    worker: WorkerId,
    reason: &str,
    now: Duration,
) -> Option<Member> {
    let member = remove(core, worker, reason, now)?;
    for lease in &member.leases {
        requeue(core, worker, lease.attempt.job);
    }
    Some(member)
}
