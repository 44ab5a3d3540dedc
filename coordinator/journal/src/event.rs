//! Journal entries: all events that a coordinator writes to the journal. Readers of a run are folds over the
//! stream of these events.
use protocol::{
    id::{ContentHash, JobId, RunId, WorkerId},
    job::{Individual, Job, Outcome},
    message::{Attempt, Cost},
    proof::ReferenceResult,
};
use serde::{Deserialize, Serialize};
use serde_bytes::ByteBuf;

/// Settings that determine the result of a run; a run is resumed only with the same settings.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunHeader {
    /// Command that began the run, e.g. `calibrate`.
    pub kind: String,
    /// Content hash of the encoded case.
    pub case: ContentHash,
    /// All other settings that determine the result of the run, as canonical JSON.
    pub settings: String,
}

/// Entry of a run's journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// First entry of the journal: identity of the run.
    Begun {
        /// Id of the run, as used in messages.
        run: RunId,
        /// Settings that determine the result of the run.
        header: RunHeader,
    },
    /// A coordinator process took over the run, either the first one or one that resumes it.
    Opened {
        /// Number of the coordinator process within the run, from 1.
        epoch: u32,
        /// Time at which the coordinator process took over the run [ms since 1970 UTC].
        at_unix_ms: u64,
    },
    /// A worker was admitted to the run.
    Joined {
        /// Id of the admitted worker.
        worker: WorkerId,
        /// Host name of the worker's machine.
        host: String,
        /// Number of slots (parallel jobs) of the worker.
        slots: u32,
        /// Digest of the worker's numerics: equal digests guarantee bitwise equal results.
        model_digest: String,
    },
    /// A worker left or was lost.
    Left {
        /// Id of the worker that left or was lost.
        worker: WorkerId,
        /// Reason in words why the worker left or is considered lost.
        reason: String,
    },
    /// A job was requested by the study; written by each coordinator process that does not find its result.
    Asked(Box<Asked>),
    /// The only accepted result of a job.
    Finished(Box<Finished>),
    /// The coordinator ended the run regularly.
    Closed,
    /// Result of the case's reference individual on the run's first worker, which every other worker must
    /// reproduce.
    Proved {
        /// Reference result: the hash of all its bits, or selected values.
        proof: ReferenceResult,
    },
    /// Use of the slots' time up to now; written periodically, when workers leave, and at the end. The last
    /// account of a worker counts.
    Accounted(Box<Account>),
    /// The study found or concluded something. Entries are numbered from 0, hold no times, and do not depend on the
    /// order in which results arrive: a resumed study finds the same again.
    Found {
        /// Number of the entry in the study.
        number: u64,
        /// Encoded entry, which the study alone interprets.
        entry: ByteBuf,
    },
}

/// Job that the study requested: what is simulated, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// Id of the requested job.
    pub job: JobId,
    /// Content hash of the encoded job; a job id denotes the same content in all coordinator processes of a run.
    pub work: ContentHash,
    /// Individual that the job simulates; none if it simulates nothing.
    pub individual: Option<Individual>,
    /// Number of parameters by which the simulation is differentiated.
    pub columns: u32,
    /// Reason for which the study requested the job.
    pub reason: JobReason,
}

impl Asked {
    /// Creates the entry of a job that is requested for a reason.
    pub fn new(id: JobId, job: &Job, reason: JobReason) -> Self {
        Self {
            job: id,
            work: job.work_hash(),
            individual: job.individual().cloned(),
            columns: u32::try_from(job.columns()).unwrap_or(u32::MAX),
            reason,
        }
    }
}

/// Reason for which a study requests a job.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobReason {
    /// Purpose in the search, or stage of the diagnosis, in one word.
    pub purpose: String,
    /// Generation of the search in which the individual was proposed; none outside a search.
    pub generation: Option<u32>,
}

impl JobReason {
    /// Creates the reason of a job that is requested outside a search.
    pub fn outside_search(purpose: &str) -> Self {
        Self {
            purpose: purpose.to_owned(),
            generation: None,
        }
    }
}

/// Use of slot time by all workers in one coordinator process.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Account {
    /// Number of the coordinator process within the run, from 1.
    pub epoch: u32,
    /// Time since the coordinator process began \[ms\].
    pub at_ms: u64,
    /// Use of slot time of each worker.
    pub workers: Vec<WorkerAccount>,
}

/// Use of the slots' time of one worker since it joined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkerAccount {
    /// Id of the worker.
    pub worker: WorkerId,
    /// Host name of the worker's machine.
    pub host: String,
    /// Number of slots (parallel jobs) of the worker.
    pub slots: u32,
    /// Number of the worker's results that were accepted.
    pub done: u64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
    /// Slot time of the worker by use.
    pub spent: Spent,
}

impl WorkerAccount {
    /// Returns the computing time of the worker's accepted results, summed over its slots \[s\].
    pub fn busy_s(&self) -> f64 {
        self.spent.useful_us as f64 / 1e6
    }

    /// Returns the share of the worker's slot time spent on accepted results, 0 to 1; `None` if the worker was not
    /// connected for a measurable time.
    pub fn busy_share(&self) -> Option<f64> {
        let connected_us = self.spent.connected_us as f64;
        (connected_us > 0.0).then(|| self.spent.useful_us as f64 / connected_us)
    }
}

/// Slot time by use \[us\]; all uses add up to the time for which slots were connected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Spent {
    /// Total time for which slots were connected: number of slots times duration.
    pub connected_us: u64,
    /// Slot time spent on computing accepted results \[us\].
    pub useful_us: u64,
    /// Idle time while the search waits for results that other slots compute.
    pub barrier_us: u64,
    /// Idle time for other reasons: fetching the case, waiting for the next job or for a journal that cannot
    /// be written, or no jobs in the run.
    pub starved_us: u64,
    /// Slot time spent on results that another worker delivered first, or on anticipated jobs that have not
    /// been requested \[us\].
    pub speculative_us: u64,
    /// Slot time spent on attempts that failed \[us\].
    pub failed_us: u64,
    /// Time spent on attempts whose worker was lost or that never got an answer.
    pub lost_us: u64,
}

impl Spent {
    /// Returns the slot time of each use with the name of the use \[us\].
    pub const fn kinds(&self) -> [(&'static str, u64); 6] {
        [
            ("useful", self.useful_us),
            ("barrier", self.barrier_us),
            ("starved", self.starved_us),
            ("speculative", self.speculative_us),
            ("failed", self.failed_us),
            ("lost", self.lost_us),
        ]
    }

    /// Returns the slot time summed over all uses \[us\].
    pub fn sum_us(&self) -> u64 {
        self.kinds().iter().map(|(_, us)| us).sum()
    }

    /// Adds the slot times of another account, use by use.
    pub const fn add(&mut self, other: &Self) {
        self.connected_us += other.connected_us;
        self.useful_us += other.useful_us;
        self.barrier_us += other.barrier_us;
        self.starved_us += other.starved_us;
        self.speculative_us += other.speculative_us;
        self.failed_us += other.failed_us;
        self.lost_us += other.lost_us;
    }
}

/// Accepted result of a job; a job has exactly one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// Attempt at the job that delivered the result.
    pub attempt: Attempt,
    /// Content hash of the encoded job that was computed.
    pub work: ContentHash,
    /// Worker that computed the result; `None` for a failure that the coordinator recorded itself.
    pub worker: Option<WorkerId>,
    /// Time that the attempt occupied the worker's slot.
    pub cost: Cost,
    /// Outcome of the job: its answer or the reason of its failure.
    pub outcome: Outcome,
}

impl Finished {
    /// Returns the id of the job that the result belongs to.
    pub const fn job(&self) -> JobId {
        self.attempt.job
    }
}
