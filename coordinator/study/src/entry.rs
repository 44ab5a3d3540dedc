//! Entries of a study in its journal: what it found and concluded, as plain data.
use search::strategy::{Best, DescentEnd, Finish};
use serde::{Deserialize, Serialize};

/// Entry of a study. It holds no times and does not depend on the order in which results arrive, so that a resumed study
/// makes the same entries again. The form of entries belongs to the journal's version ([`journal::VERSION`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Entry {
    /// Notes about the case and its records, one sentence each.
    Noted(Vec<String>),
    /// Result of the search of a calibration; its evaluations are the recorded jobs.
    Calibrated {
        /// Best individual found by the search.
        best: Best,
        /// Stopping criterion that ended the search.
        finish: Finish,
        /// Ends of the search's least-squares descents that converged.
        descent_ends: Vec<DescentEnd>,
        /// Digest of the evaluation log.
        digest: String,
    },
}
