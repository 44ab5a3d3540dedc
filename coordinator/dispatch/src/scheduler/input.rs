//! Inputs and commands of the scheduler core.
use super::{
    completed::Completed,
    notice::{Notice, StopReason},
};
use journal::event::{Event, Finished};
use protocol::{
    id::{JobId, WorkerId},
    job::Job,
    message::{FromWorker, ToWorker},
};
use std::time::Duration;

/// Options for draining a worker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drain {
    /// Whether the drained worker returns its jobs to the coordinator at once; otherwise it finishes them
    /// first.
    pub now: bool,
    /// Whether the drained worker's process ends once it holds no job; otherwise it stays connected and idle.
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
    /// A job is computed ahead if a slot would be idle, because the run will probably request it.
    Anticipate {
        /// Identifier of the anticipated job.
        id: JobId,
        /// Content of the anticipated job.
        job: Job,
    },
    /// Anticipated jobs are requested now.
    Claim {
        /// Jobs that were anticipated before.
        jobs: Vec<JobId>,
    },
    /// Anticipated jobs will not be requested.
    Withdraw {
        /// Jobs that were anticipated before; their ids are not used again.
        jobs: Vec<JobId>,
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
        /// Jobs whose results are now safely in the journal.
        jobs: Vec<JobId>,
    },
    /// Whether the journal can be written, sent at each change; the journal counts as writable initially.
    Writable(bool),
    /// Report that the coordinator's machine was suspended, during which its clock stood still.
    Suspended {
        /// Duration for which the coordinator's machine was suspended.
        time: Duration,
    },
    /// A worker is to be drained.
    Drain {
        /// Identifier of the worker to drain.
        worker: WorkerId,
        /// Options of the drain: whether jobs are returned at once, and whether the worker ends.
        how: Drain,
    },
    /// Periodic call without other input, at which deadlines and timeouts are checked.
    Tick,
    /// No further jobs are to be assigned; accepted results are still written.
    Finish,
    /// End of the run, of which the workers must be notified.
    Close,
}

/// Command that the scheduler core emits for the runtime to execute.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Send a message to a worker.
    Send {
        /// Worker to which the message is sent.
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
    /// Show a notice to the user.
    Notice(Notice),
    /// Stop the run, which cannot continue.
    Stop(StopReason),
}
