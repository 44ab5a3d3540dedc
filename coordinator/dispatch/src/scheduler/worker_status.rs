//! Detailed list of a run's workers, built on request for control clients.
use super::state::Core;
use protocol::id::{JobId, WorkerId};
use std::time::Duration;

/// State of a connected worker at a moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectedWorker {
    /// Identifier of the worker.
    pub id: WorkerId,
    /// Host name of the worker.
    pub host: String,
    /// Process id of the worker on its host.
    pub process: u32,
    /// Number of jobs that the worker can run simultaneously.
    pub slots: u32,
    /// Version and build profile of the worker program.
    pub build: String,
    /// Whether the worker has the case and has proved that its results agree with those of the run.
    pub is_ready: bool,
    /// Whether the worker is being drained and gets no new jobs.
    pub is_drained: bool,
    /// Jobs held by the worker, in the order of sending, with the time since each was sent.
    pub jobs: Vec<(JobId, Duration)>,
    /// Number of successful results that the worker has delivered.
    pub done: u64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
    /// Time since the worker joined.
    pub present: Duration,
    /// Time since the worker's last message.
    pub silent: Duration,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "nobody below needs to know what is shown of the state"
)]
impl Core {
    /// Returns all connected workers, ordered by id.
    pub fn worker_statuses(&self, now: Duration) -> Vec<ConnectedWorker> {
        let hands = self.members.iter().map(|(id, member)| {
            let leases = member.leases.iter();
            ConnectedWorker {
                id: *id,
                host: member.announcement.host.clone(),
                process: member.announcement.pid,
                slots: member.announcement.slots,
                build: member.announcement.build.clone(),
                is_ready: member.ready,
                is_drained: member.drained,
                jobs: leases
                    .map(|lease| (lease.attempt.job, now.saturating_sub(lease.sent)))
                    .collect(),
                done: member.done,
                failed: member.failed,
                present: now.saturating_sub(member.joined_at),
                silent: now.saturating_sub(member.last_heard),
            }
        });
        hands.collect()
    }
}
