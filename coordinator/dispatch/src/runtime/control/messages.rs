//! Messages of a run's control socket: a request and an answer, each one line of JSON.
//!
//! ```text
//! {"ask": "list"}
//! {"ask": "drain", "names": ["worker-03"], "now": false, "end": false}
//!     -> {"workers": [{"name": "worker-03", "id": "...", ...}]}   all workers, or those named
//!     -> {"error": "no worker is called ..."}
//! ```
use serde::{Deserialize, Serialize};

/// Request to a run's control socket.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
pub enum ControlRequest {
    /// Request for a list of all workers of the run.
    List,
    /// Request to drain workers: they get no further jobs.
    Drain {
        /// Workers to drain, by key name, host or id; all workers if empty.
        names: Vec<String>,
        /// Whether workers return their unfinished jobs at once.
        now: bool,
        /// Whether workers end once they hold no job.
        end: bool,
    },
}

/// Answer to a control request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControlReply {
    /// Workers concerned by the request.
    Workers(Vec<WorkerReport>),
    /// Reason why the request was refused.
    Error(String),
}

/// State of a connected worker, as `workers list` prints it in a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkerReport {
    /// Name in the worker's certificate; `anyone` without key material.
    pub name: String,
    /// Identifier of the worker process, 16 hexadecimal digits.
    pub id: String,
    /// Host name of the worker.
    pub host: String,
    /// Whether the run started the worker on its own machine.
    #[serde(default)]
    pub local: bool,
    /// Number of slots of the worker, i.e. of simultaneous simulations.
    pub slots: u32,
    /// Version and build profile of the worker program.
    pub version: String,
    /// Phase of the worker: joining, working, draining or drained.
    pub state: WorkerPhase,
    /// Jobs held by the worker, those running in slots first.
    pub jobs: Vec<HeldJob>,
    /// Number of results that the worker has delivered.
    pub done: u64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
    /// Results per minute that the worker has delivered since it joined.
    pub per_minute: f64,
    /// Time since the worker joined \[s\].
    pub present_s: f64,
    /// Time since the last message of the worker \[s\]; workers send one every second.
    pub last_seen_s: f64,
}

/// Phase of a worker's participation in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WorkerPhase {
    /// The worker is fetching the case and proving that its results equal those of the other workers.
    Joining,
    /// The worker takes jobs.
    Working,
    /// The worker finishes its jobs and gets no more.
    Draining,
    /// The worker holds no job and gets none.
    Drained,
}

/// Job held by a worker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldJob {
    /// Number of the job.
    pub job: u64,
    /// Time since the job was sent \[s\].
    pub for_s: f64,
}
