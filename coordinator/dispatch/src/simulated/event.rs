//! Events of a simulated cluster.
use crate::scheduler::Drain;
use protocol::{
    id::{JobId, WorkerId},
    message::{Attempt, FromWorker, ToWorker},
};

/// Fault injected into a simulated cluster, for workers at the place for which it is scheduled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// Terminates the worker, whose jobs are lost; the transport reports the loss, and a new worker takes its
    /// place.
    Kill,
    /// Terminates the worker like [`Self::Kill`]; its place stays empty.
    Vanish,
    /// Fills the place with a new worker that is sound, if it is empty or its worker is not.
    Return,
    /// Suspends the worker while its connection stays open.
    Freeze,
    /// Resumes a frozen worker.
    Thaw,
    /// Interrupts all messages to and from the worker; the transport reports the loss after some seconds.
    Partition,
    /// Ends an interruption.
    Heal,
    /// Drains the worker.
    Drain(Drain),
    /// The worker refuses all jobs from now on.
    Refuse,
    /// Replaces the worker by one that gives another result of the reference individual.
    Differ,
    /// The coordinator's disk takes no more bytes.
    FillDisk,
    /// The coordinator's disk takes bytes again.
    FreeDisk,
    /// Kills the coordinator, which is started again some seconds later. Of the bytes that it is writing, as many reach
    /// the disk as this number leaves when divided by their number and one.
    Crash(usize),
}

/// Event of the simulated cluster, scheduled at a simulated time.
#[derive(Clone)]
pub(super) enum ClusterEvent {
    Up(WorkerId, FromWorker),
    /// End of the coordinator's handling time of a worker's message, at which the scheduler core receives the
    /// message.
    Heard(WorkerId, FromWorker),
    Down(WorkerId, ToWorker),
    End(WorkerId, Attempt),
    Beat(WorkerId),
    Tick,
    Stored(Vec<JobId>),
    /// The journal is written to the disk.
    Flush,
    /// The transport notices that a worker cannot be reached.
    Unreachable(WorkerId),
    /// The coordinator is started again.
    Start,
    Fault(u64, Fault),
}
