//! Inputs and commands of the scheduler core.
use super::{
    completed::Completed,
    notice::{Notice, StopReason},
};
use protocol::{
    event::{Event, Finished},
    id::{JobId, WorkerId},
    job::Job,
    message::{FromWorker, ToWorker},
};
use std::time::Duration;

/// Options for draining a worker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drain {
    /// Whether the worker returns its jobs at once; otherwise it finishes them.
    pub now: bool,
    /// Whether the worker ends once it holds no job; otherwise it stays idle.
    pub end: bool,
}

/// Input to the scheduler core.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A job is submitted; ids of a run are never reused for other work.
    Submit {
        /// Identifier of the job.
        id: JobId,
        /// Content of the submitted job: the work to execute.
        job: Job,
    },
    /// A message from a worker arrived.
    Message {
        /// Identifier of the worker.
        from: WorkerId,
        /// Message of the worker.
        message: FromWorker,
    },
    /// A worker sent a message that belongs to another run.
    OtherRun {
        /// Identifier of the worker that belongs to another run.
        from: WorkerId,
    },
    /// A worker sent a message in another version of the wire protocol.
    OtherVersion {
        /// Identifier of the worker with the other protocol version.
        from: WorkerId,
        /// Version used by the worker.
        version: u8,
    },
    /// The transport lost the connection to a worker.
    Disconnected {
        /// Identifier of the worker whose connection was lost.
        worker: WorkerId,
    },
    /// Results were safely written to the journal.
    Stored {
        /// Jobs whose results are safe.
        jobs: Vec<JobId>,
    },
    /// The journal became writable or unwritable; it is writable initially.
    Writable(bool),
    /// The machine was suspended, and its clock stood still.
    Suspended {
        /// Duration of the suspend.
        time: Duration,
    },
    /// A worker is to be drained.
    Drain {
        /// Identifier of the worker to drain.
        worker: WorkerId,
        /// Options of the drain: whether jobs are returned at once, and whether the worker ends.
        how: Drain,
    },
    /// Time has passed; deadlines must be checked.
    Tick,
    /// No further jobs are to be assigned; accepted results are still written.
    Finish,
    /// The run ends.
    Close,
}

/// Command that the scheduler core emits for the runtime to execute.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Send a message to a worker.
    Send {
        /// Recipient.
        to: WorkerId,
        /// Message to send to the worker.
        message: ToWorker,
    },
    /// Write a result to the journal and answer [`Input::Stored`] once it is safe.
    Store(Box<Finished>),
    /// Write an event to the journal; no answer is needed.
    Record(Event),
    /// Deliver a result to the submitter of the job.
    Deliver(Completed),
    /// Report to the user.
    Notice(Notice),
    /// Stop the run, which cannot continue.
    Stop(StopReason),
}
