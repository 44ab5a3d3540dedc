//! Everything that coordinator, worker and slot say to each other: one enum per direction.
use crate::{
    announce::Announcement,
    id::{AttemptId, ContentHash, JobId},
    job::{Job, Outcome},
    proof::Proof,
};
use serde::{Deserialize, Serialize};

/// One try at one job; what leases, results and acknowledgements are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Attempt {
    /// The job.
    pub job: JobId,
    /// Which try.
    pub attempt: AttemptId,
}

/// Coordinator to worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToWorker {
    /// "I do not know you": announce yourself (again).
    Identify,
    /// The worker takes part; the run is the frame's.
    Admitted {
        /// Which coordinator process of that run, counted from 1.
        epoch: u32,
        /// Name of the case, to be fetched as a blob before any job.
        case: ContentHash,
        /// Its length (bytes).
        case_bytes: u64,
    },
    /// The worker may not take part.
    Refused {
        /// Which field of the announcement differs, and what to do.
        reason: String,
    },
    /// A job; doing it twice does no harm.
    Run(Box<Order>),
    /// The result is no longer wanted.
    Cancel(Attempt),
    /// These results are in the journal: forget them.
    Stored(Vec<Attempt>),
    /// The run is over; there will be no more work from this coordinator.
    Ended,
}

/// A job as it is given to a worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Which try at which job.
    pub attempt: Attempt,
    /// From start to forced end \[ms\].
    pub deadline_ms: u64,
    /// What to do.
    pub job: Job,
}

/// Worker to coordinator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromWorker {
    /// Who I am.
    Announce(Box<Announcement>),
    /// I am alive, and this is what I hold.
    Beat(Beat),
    /// A job is done.
    Done(Box<Done>),
    /// I end; offer what I hold to others.
    Leaving {
        /// Why.
        reason: String,
    },
}

/// Proof of life, each second; also the truth about what a worker holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Beat {
    /// Counts up from 0.
    pub number: u64,
    /// The case it has fetched and checked; without it no job but [`Job::Nothing`] can be done.
    pub case: Option<ContentHash>,
    /// What the reference individual of that case came to here; without it no job is given.
    pub proof: Option<Proof>,
    /// Attempts in a slot.
    pub running: Vec<Attempt>,
    /// Attempts that wait for a slot.
    pub waiting: Vec<Attempt>,
    /// Attempts whose results are not yet acknowledged.
    pub finished: Vec<Attempt>,
}

/// What a job took of the slot that did it. It decides nothing and enters no digest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cost {
    /// Time in the slot \[us\].
    pub wall_us: u64,
    /// Processor time of the slot's process meanwhile \[us\]; 0 if it came to no answer.
    pub cpu_us: u64,
}

impl Cost {
    /// Time in the slot \[s\].
    pub const fn wall_s(self) -> f64 {
        self.wall_us as f64 / 1e6
    }

    /// Processor time \[s\].
    pub const fn cpu_s(self) -> f64 {
        self.cpu_us as f64 / 1e6
    }
}

/// A result, kept by the worker until it is acknowledged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Which try at which job.
    pub attempt: Attempt,
    /// Hash of the job that was done, so that a result never answers another question.
    pub work: ContentHash,
    /// What it took.
    pub cost: Cost,
    /// What came out.
    pub outcome: Outcome,
}

/// Worker process to slot process, over the slot's standard input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToSlot {
    /// The encoded case for all following jobs.
    Case(#[serde(with = "serde_bytes")] Vec<u8>),
    /// Do this.
    Run(Box<Job>),
}

/// Slot process to worker process, over the slot's standard output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromSlot {
    /// The slot's process is ready.
    Ready,
    /// The last job is done.
    Done {
        /// What came out.
        outcome: Box<Outcome>,
        /// Processor time that it took \[us\].
        cpu_us: u64,
    },
}
