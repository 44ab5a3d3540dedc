//! Result of a search on a number of slots, and the run of empty jobs on which it is measured.
use dispatch::runtime::DispatchOptions;
use protocol::{case::Case, wire::WireError};
use serde::Serialize;
use std::path::Path;
use study::scaling::Shares;

/// Search on a number of slots.
#[derive(Debug, Serialize)]
pub(super) struct SlotRow {
    /// `slept` or `projected`.
    pub(super) how: &'static str,
    pub(super) preset: String,
    pub(super) slots: u64,
    pub(super) evaluations: u64,
    pub(super) wall_s: f64,
    /// Shares of slot time by use.
    pub(super) shares: Shares,
    /// Processor time of the coordinator over the wall time.
    pub(super) coordinator_share: f64,
}

/// Returns the dispatcher options of a run of empty jobs.
pub(super) fn empty_run(folder: &Path) -> Result<DispatchOptions, WireError> {
    DispatchOptions::local(folder, 0, &Case::default(), "bench", "{}".to_owned())
}
