//! Events of a simulated cluster.
use protocol::{
    id::{JobId, WorkerId},
    message::{Attempt, FromWorker, ToWorker},
};

/// Fault injected into a worker.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// Terminates the worker with all its jobs; the transport reports the loss, and a new worker takes its
    /// place.
    Kill,
    /// Suspends the worker while its connection stays open.
    Freeze,
    /// Resumes a frozen worker.
    Thaw,
}

/// Event on the simulated clock.
#[derive(Clone)]
pub(super) enum What {
    Up(WorkerId, FromWorker),
    /// Message that the coordinator has finished receiving and now processes.
    Heard(WorkerId, FromWorker),
    Down(WorkerId, ToWorker),
    End(WorkerId, Attempt),
    Beat(WorkerId),
    Tick,
    Stored(Vec<JobId>),
    Fault(u64, Fault),
}
