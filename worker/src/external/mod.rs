//! Models that are external programs: input files, a process, output files.
//!
//! ```text
//! values -> templates (fill) -> folder (scratch, in own_folder) -> process (run) -> output files -> curves (gather)
//!                                                                \-> files of a failed run (leftover_files)
//! ```
//!
//! The computer on which the worker runs decides which programs may be started: a case can only choose an
//! entry of that computer's list of allowed programs (`exchange::allow`). This module does not know the
//! meaning of the numbers.
mod fill;
mod gather;
mod leftover_files;
mod model;
mod own_folder;
mod run;
mod scratch_folder;
mod simulator;
pub mod start;

pub use simulator::Externals;

/// Removes the folders left behind by a slot that was ended during a run.
pub(crate) fn remove_abandoned() {
    // without a list nothing was ever started here
    let allowed = exchange::allow::read(&exchange::allow::path()).unwrap_or_default();
    let places = allowed.entry.values().map(scratch_folder::parent);
    let places: std::collections::BTreeSet<std::path::PathBuf> = places.collect();
    for place in places {
        scratch_folder::clean(&place);
    }
}
