//! Messages of a run's control socket: a request and an answer, each one line of JSON.
//!
//! ```text
//! {"ask": "list"}
//! {"ask": "drain", "names": ["worker-03"], "now": false, "end": false}
//!     -> {"workers": [{"name": "worker-03", "id": "...", ...}]}   all workers, or those named
//!     -> {"error": "no worker is called ..."}
//! ```
use crate::scheduler::WorkerReport;
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
