//! Events of a simulated cluster.
use protocol::{
    id::{JobId, WorkerId},
    message::{Attempt, FromWorker, ToWorker},
};

/// Fault injected into a worker.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// Terminates the worker, whose jobs are lost; the transport reports the loss, and a new worker takes its
    /// place.
    Kill,
    /// Suspends the worker while its connection stays open.
    Freeze,
    /// Resumes a frozen worker.
    Thaw,
}

/// Event on the simulated clock.
#[derive(Clone)]
pub(super) enum ClusterEvent {
    Up(WorkerId, FromWorker),
    /// End of the coordinator's handling of a worker's message, which the scheduler core now receives.
    Heard(WorkerId, FromWorker),
    Down(WorkerId, ToWorker),
    End(WorkerId, Attempt),
    Beat(WorkerId),
    Tick,
    Stored(Vec<JobId>),
    Fault(u64, Fault),
}
