//! What can happen in a simulated cluster.
use protocol::{
    id::{JobId, WorkerId},
    message::{Attempt, FromWorker, ToWorker},
};

/// What happens to workers.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// It dies with all it holds, the transport says so, and another one comes in its place.
    Kill,
    /// It stands still; its connection stays.
    Freeze,
    /// It goes on.
    Thaw,
}

/// One event on the simulated clock.
#[derive(Clone)]
pub(super) enum What {
    Up(WorkerId, FromWorker),
    /// What was said is taken in.
    Heard(WorkerId, FromWorker),
    Down(WorkerId, ToWorker),
    End(WorkerId, Attempt),
    Beat(WorkerId),
    Tick,
    Stored(Vec<JobId>),
    Fault(u64, Fault),
}
