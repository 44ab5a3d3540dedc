//! Who works, for people that ask: more than a snapshot, and made only then.
use super::state::Core;
use protocol::id::{JobId, WorkerId};
use std::time::Duration;

/// A worker that takes part, at a moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hand {
    /// Its id.
    pub id: WorkerId,
    /// Its machine.
    pub host: String,
    /// Jobs it can compute at a time.
    pub slots: u32,
    /// Version and profile of its program.
    pub build: String,
    /// It has the case and has proved its numerics.
    pub is_ready: bool,
    /// It gets no new jobs.
    pub is_drained: bool,
    /// Jobs it holds, in the order in which they were sent, and for how long.
    pub jobs: Vec<(JobId, Duration)>,
    /// Jobs it has brought results of.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// For how long it has taken part.
    pub present: Duration,
    /// For how long it has not been heard.
    pub silent: Duration,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "nobody below needs to know what is shown of the state"
)]
impl Core {
    /// Everybody that takes part, by id.
    pub fn crew(&self, now: Duration) -> Vec<Hand> {
        let hands = self.members.iter().map(|(id, member)| {
            let leases = member.leases.iter();
            Hand {
                id: *id,
                host: member.announcement.host.clone(),
                slots: member.announcement.slots,
                build: member.announcement.build.clone(),
                is_ready: member.ready,
                is_drained: member.drained,
                jobs: leases
                    .map(|lease| (lease.attempt.job, now.saturating_sub(lease.sent)))
                    .collect(),
                done: member.done,
                failed: member.failed,
                present: now.saturating_sub(member.since),
                silent: now.saturating_sub(member.heard),
            }
        });
        hands.collect()
    }
}
