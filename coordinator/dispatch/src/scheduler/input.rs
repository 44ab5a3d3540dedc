//! What the core is told, and what it wants done.
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

/// How a worker is taken out of the work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drain {
    /// What it holds is handed back at once; otherwise it finishes that.
    pub now: bool,
    /// It ends when it holds nothing; otherwise it stays, idle.
    pub end: bool,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A job is to be done; ids of a run are never reused for other work.
    Submit {
        /// Its name.
        id: JobId,
        /// What to do.
        job: Job,
    },
    /// A worker spoke.
    Heard {
        /// The worker's name.
        from: WorkerId,
        /// What it said.
        message: FromWorker,
    },
    /// A worker spoke of another run.
    Stranger {
        /// The worker's name.
        from: WorkerId,
    },
    /// A worker spoke in words of another version of the wire.
    OtherVersion {
        /// The worker's name.
        from: WorkerId,
        /// The version.
        version: u8,
    },
    /// The transport lost a worker.
    Gone {
        /// The worker's name.
        worker: WorkerId,
    },
    /// These results are safe in the journal.
    Stored {
        /// Their jobs.
        jobs: Vec<JobId>,
    },
    /// Whether the journal can be written; it can at the beginning.
    Writable(bool),
    /// The machine has slept, and its clock stood still.
    Slept {
        /// For how long it slept.
        time: Duration,
    },
    /// Somebody takes a worker out of the work.
    Drain {
        /// The worker's name.
        worker: WorkerId,
        /// How.
        how: Drain,
    },
    /// Time has passed.
    Tick,
    /// Nothing more is to be given out; what is accepted is still written.
    Finish,
    /// The run is over.
    Close,
}

/// Something the runtime must do.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Send a message.
    Send {
        /// The worker that it is for.
        to: WorkerId,
        /// What it says.
        message: ToWorker,
    },
    /// Write a result to the journal and answer [`Input::Stored`] once it is safe.
    Store(Box<Finished>),
    /// Write to the journal when convenient.
    Record(Event),
    /// Hand a result to whoever submitted the job.
    Deliver(Completed),
    /// Tell people.
    Notice(Notice),
    /// The run cannot go on.
    Stop(Stop),
}
