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
    Fault(u64, Fault),
}
