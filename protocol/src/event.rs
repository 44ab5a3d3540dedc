//! Everything that enters the journal. Readers of a run are folds over a stream of these.
use crate::{
    id::{ContentHash, JobId, RunId, WorkerId},
    job::Outcome,
    message::{Attempt, Cost},
    proof::Proof,
};
use serde::{Deserialize, Serialize};

/// What decides the result of a run; a run is only resumed with the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunHeader {
    /// Which command the run belongs to, as `calibrate`.
    pub kind: String,
    /// Hash of the encoded case.
    pub case: ContentHash,
    /// Canonical JSON of everything else that decides the result.
    pub settings: String,
}

/// One line of a run's history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// First record: what the run is.
    Begun {
        /// Its name on the wire.
        run: RunId,
        /// What decides its result.
        header: RunHeader,
    },
    /// A coordinator process took the run over.
    Opened {
        /// Counts the processes from 1.
        epoch: u32,
        /// When [ms since 1970 UTC].
        at_unix_ms: u64,
    },
    /// A worker was admitted.
    Joined {
        /// The worker.
        worker: WorkerId,
        /// Its machine.
        host: String,
        /// Its slots.
        slots: u32,
        /// Its numerics.
        model_digest: String,
    },
    /// A worker left or was lost.
    Left {
        /// The worker.
        worker: WorkerId,
        /// Why, in words.
        reason: String,
    },
    /// A job was asked for.
    Asked {
        /// The job.
        job: JobId,
        /// Hash of the encoded job: a number stands for one content in all processes of a run.
        work: ContentHash,
    },
    /// A job has its one accepted result.
    Finished(Box<Finished>),
    /// The coordinator ended the run by itself.
    Closed,
    /// What the case's reference individual came to on the run's first worker: every other one
    /// must come to the same.
    Proved {
        /// The bits, or some of the values.
        proof: Proof,
    },
    /// How slots spent their time until now; written now and then, when workers go, and at the
    /// end. The last one of a worker counts.
    Accounted(Box<Account>),
}

/// How the slots of workers spent their time.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Account {
    /// Counts the coordinator's processes from 1.
    pub epoch: u32,
    /// Time since that process began \[ms\].
    pub at_ms: u64,
    /// By worker.
    pub workers: Vec<WorkerAccount>,
}

/// How the slots of one worker spent their time, since it joined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkerAccount {
    /// The worker.
    pub worker: WorkerId,
    /// Its machine.
    pub host: String,
    /// Its slots.
    pub slots: u32,
    /// Results of it that were accepted.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// Its slot time by use.
    pub spent: Spent,
}

/// Slot time by use \[us\]; the kinds add up to the time that slots were connected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Spent {
    /// Slots times the time they were connected.
    pub connected_us: u64,
    /// Computing results that were accepted.
    pub useful_us: u64,
    /// Without a job, because the search waits for results that others compute.
    pub barrier_us: u64,
    /// Without a job though the run is not waiting for others: fetching the case, waiting for the
    /// next order or for a journal that cannot be written, or the run asked for nothing.
    pub starved_us: u64,
    /// Computing results that another worker brought first.
    pub speculative_us: u64,
    /// On attempts that failed.
    pub failed_us: u64,
    /// On attempts whose worker was lost, or that nobody answered for.
    pub lost_us: u64,
}

impl Spent {
    /// The kinds, with their names.
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

    /// All kinds together \[us\].
    pub fn sum_us(&self) -> u64 {
        self.kinds().iter().map(|(_, us)| us).sum()
    }

    /// Adds another account.
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

/// The one accepted result of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// The attempt that brought it.
    pub attempt: Attempt,
    /// Hash of the encoded job.
    pub work: ContentHash,
    /// Who did it; none for a failure that the coordinator states itself.
    pub worker: Option<WorkerId>,
    /// What it took.
    pub cost: Cost,
    /// What came out.
    pub outcome: Outcome,
}

impl Finished {
    /// The job this answers.
    pub const fn job(&self) -> JobId {
        self.attempt.job
    }
}
