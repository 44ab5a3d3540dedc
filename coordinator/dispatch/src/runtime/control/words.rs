//! What is said through the socket of a run: a question and an answer, each one line of JSON.
//!
//! ```text
//! {"ask": "list"}
//! {"ask": "drain", "names": ["worker-03"], "now": false, "end": false}
//!     -> {"workers": [{"name": "worker-03", "id": "...", ...}]}   all of them, or those that are meant
//!     -> {"error": "no worker is called ..."}
//! ```
use serde::{Deserialize, Serialize};

/// A question.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
pub enum Question {
    /// Who works?
    List,
    /// Take workers out of the work.
    Drain {
        /// Whom, by the names of their keys, by host or by id; everybody if empty.
        names: Vec<String>,
        /// Hand back at once what they hold.
        now: bool,
        /// End once they hold nothing.
        end: bool,
    },
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reply {
    /// The workers that were asked for.
    Workers(Vec<Worker>),
    /// Why there is no answer.
    Error(String),
}

/// A worker that takes part: a line of `workers list`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worker {
    /// Name of its keys; `anyone` without.
    pub name: String,
    /// Its process, 16 hexadecimal digits.
    pub id: String,
    /// Its machine.
    pub host: String,
    /// Simulations it computes at a time.
    pub slots: u32,
    /// Version and profile of its program.
    pub version: String,
    /// What it does.
    pub state: State,
    /// Jobs it holds, those in its slots first.
    pub jobs: Vec<Job>,
    /// Results it brought.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// Results a minute since it joined.
    pub per_minute: f64,
    /// Since it joined \[s\].
    pub present_s: f64,
    /// Since it was last heard \[s\]; workers speak every second.
    pub last_seen_s: f64,
}

/// What a worker does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It fetches the case and shows that it computes as the others do.
    Joining,
    /// It takes jobs.
    Working,
    /// It finishes its jobs and gets no more.
    Draining,
    /// It holds nothing and gets nothing.
    Drained,
}

/// A job in the hands of a worker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// Its number.
    pub job: u64,
    /// Since it was sent \[s\].
    pub for_s: f64,
}
