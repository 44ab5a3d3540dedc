//! Snapshot of the state of a run, for progress lines and reports.
use super::state::Core;
use journal::event::{Spent, WorkerAccount};
use std::time::Duration;

/// State of a run at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Connected workers, by id, with their use of slot time.
    pub workers: Vec<WorkerAccount>,
    /// Number of slots without a job.
    pub idle: usize,
    /// Number of jobs waiting for a worker.
    pub queued: usize,
    /// Number of jobs held by workers.
    pub running: usize,
    /// Number of jobs with an accepted result, from this and earlier processes of the run.
    pub done: usize,
    /// Number of workers lost by this process.
    pub lost: u32,
    /// Number of jobs given up by this process.
    pub failed: u32,
    /// Number of attempts repeated after a loss or a failure, by this process.
    pub repeated: u32,
    /// Number of copies of slow jobs given to idle workers by this process.
    pub copies: u32,
    /// Number of results that arrived after another had been accepted.
    pub duplicates: u64,
    /// Slot time of all workers by use, including workers that left.
    pub spent: Spent,
    /// Time in this process during which at least one worker held a job; excludes the time in which workers
    /// fetch the case and build the model.
    pub computing: Duration,
    /// Whether dispatch is paused because the journal cannot be written.
    pub paused: bool,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "nobody below needs to know what is shown of the state"
)]
impl Core {
    /// Returns a snapshot of the scheduler core's state at the given time.
    pub fn snapshot(&self, now: Duration) -> Snapshot {
        let mut spent = self.counts.departed_slot_time;
        let mut clocks = self.clocks;
        clocks.advance(now);
        let mut idle = 0;
        let mut workers = Vec::with_capacity(self.members.len());
        for (id, member) in &self.members {
            let row = member.account_row(*id, &clocks);
            spent.add(&row.spent);
            idle += member.slots().saturating_sub(member.leases.len());
            workers.push(row);
        }
        Snapshot {
            workers,
            idle,
            queued: self.queue.len(),
            running: self.held_jobs(),
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
