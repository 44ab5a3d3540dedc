//! Removal of workers from the run.
use super::{lease::requeue, member::Member, state::Core};
use journal::event::Event;
use protocol::id::WorkerId;
use std::time::Duration;

/// Removes a worker from the run, books its running attempts as lost and records its last slot-time account.
pub(super) fn remove(
    core: &mut Core,
    worker: WorkerId,
    reason: &str,
    now: Duration,
) -> Option<Member> {
    let mut member = core.members.remove(&worker)?;
    member.lose_leases(&core.clocks);
    let row = member.account_row(worker, &core.clocks);
    core.counts.departed_slot_time.add(&row.spent);
    core.record_account(vec![row], now);
    let reason = reason.to_owned();
    core.record(Event::Left { worker, reason });
    Some(member)
}

/// Removes a worker without counting a failure against its jobs, which are requeued.
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
