//! The state of a run at a moment, for progress lines and reports.
use super::state::Core;
use protocol::{event::Spent, id::WorkerId};
use std::time::Duration;

/// A moment of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Workers that take part, by id.
    pub workers: Vec<WorkerSnapshot>,
    /// Jobs that wait for a worker.
    pub queued: usize,
    /// Jobs that a worker holds.
    pub running: usize,
    /// Jobs with an accepted result, of this and earlier processes of the run.
    pub done: usize,
    /// Workers lost by this process.
    pub lost: u32,
    /// Jobs given up by this process.
    pub failed: u32,
    /// Attempts after one that was lost or failed, by this process.
    pub repeated: u32,
    /// Copies of slow jobs that idle workers were given, by this process.
    pub copies: u32,
    /// Results that came after another had been accepted.
    pub duplicates: u64,
    /// Slot time of all workers by use, those that left included.
    pub spent: Spent,
    /// For how long anybody has held a job, in this process: nobody is given one before the worker
    /// has the case and has built the model.
    pub computing: Duration,
    /// Whether the journal cannot be written, so that nothing is given out.
    pub paused: bool,
}

/// A worker at a moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkerSnapshot {
    /// Its id.
    pub id: WorkerId,
    /// Its machine.
    pub host: String,
    /// Jobs it can compute at a time.
    pub slots: u32,
    /// Jobs it computes.
    pub busy: u32,
    /// Jobs it has brought results of.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// Its slot time by use, since it joined.
    pub spent: Spent,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "nobody below needs to know what is shown of the state"
)]
impl Core {
    /// The state at a time.
    pub fn snapshot(&self, now: Duration) -> Snapshot {
        let mut spent = self.counts.past;
        let mut clocks = self.clocks;
        clocks.advance(now);
        let mut workers = Vec::with_capacity(self.members.len());
        for (id, member) in &self.members {
            let of_worker = member.spent(&clocks);
            spent.add(&of_worker);
            workers.push(WorkerSnapshot {
                id: *id,
                host: member.announcement.host.clone(),
                slots: member.announcement.slots,
                busy: u32::try_from(member.leases.len().min(member.slots())).unwrap_or(u32::MAX),
                done: member.done,
                failed: member.failed,
                spent: of_worker,
            });
        }
        Snapshot {
            workers,
            queued: self.queue.len(),
            running: self.jobs.len() - self.queue.len(),
            done: self.finished.len() + self.storing.len(),
            lost: self.counts.lost,
            failed: self.counts.failed,
            repeated: self.counts.repeated,
            copies: self.counts.copies,
            duplicates: self.counts.duplicates,
            spent,
            computing: clocks.computing,
            paused: self.paused,
        }
    }
}
