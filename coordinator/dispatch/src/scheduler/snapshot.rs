//! Snapshot of the state of a run, for progress lines and reports.
use super::state::Core;
use journal::event::Spent;
use protocol::id::WorkerId;
use std::time::Duration;

/// State of a run at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Connected workers, by id.
    pub workers: Vec<WorkerSnapshot>,
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

/// State of a worker at one moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkerSnapshot {
    /// Identifier of the worker.
    pub id: WorkerId,
    /// Host name of the worker's machine.
    pub host: String,
    /// Number of slots, that is, jobs computed at a time.
    pub slots: u32,
    /// Number of jobs that the worker is computing.
    pub busy: u32,
    /// Number of results delivered by the worker.
    pub done: u64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
    /// Slot time of the worker by use, since it joined.
    pub spent: Spent,
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
