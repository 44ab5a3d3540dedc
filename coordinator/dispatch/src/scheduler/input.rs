//! Inputs and commands of the scheduler core.
use super::{
    completed::Completed,
    notice::{Notice, Stop},
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
        /// Request to execute.
        job: Job,
    },
    /// A message from a worker arrived.
    Heard {
        /// Identifier of the worker.
        from: WorkerId,
        /// Message of the worker.
        message: FromWorker,
    },
    /// A worker sent a message that belongs to another run.
    Stranger {
        /// Identifier of the worker.
        from: WorkerId,
    },
    /// A worker sent a message in another version of the wire protocol.
    OtherVersion {
        /// Identifier of the worker.
        from: WorkerId,
        /// Version used by the worker.
        version: u8,
    },
    /// The transport lost the connection to a worker.
    Gone {
        /// Identifier of the worker.
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
    Slept {
        /// Duration of the suspend.
        time: Duration,
    },
    /// A worker is to be drained.
    Drain {
        /// Identifier of the worker.
        worker: WorkerId,
        /// Drain options.
        how: Drain,
    },
    /// Time has passed; deadlines must be checked.
    Tick,
    /// No further jobs are to be assigned; accepted results are still written.
    Finish,
    /// The run ends.
    Close,
}

/// Command of the scheduler core to the runtime.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Send a message to a worker.
    Send {
        /// Recipient.
        to: WorkerId,
        /// Message.
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
    Stop(Stop),
}
