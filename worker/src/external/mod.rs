//! Models that are programs of somebody's own: files in, a process, files out.
//!
//! ```text
//! values -> templates (fill) -> folder (scratch) -> process (run) -> readings -> curves (gather)
//!                                                              \-> what a failure leaves (left)
//! ```
//!
//! What may be started is this machine's own decision: a list that a case can only choose an entry of
//! (`exchange::allow`). Nothing here knows what the numbers mean.
mod fill;
mod gather;
mod left;
mod model;
mod run;
mod scratch;
mod simulator;
pub mod start;

pub use simulator::Externals;

/// Removes what a slot left that was ended in the middle of a run.
pub(crate) fn tidy() {
    // without a list nothing was ever started here
    let allowed = exchange::allow::read(&exchange::allow::path()).unwrap_or_default();
    let places = allowed.entry.values().map(scratch::place);
    let places: std::collections::BTreeSet<std::path::PathBuf> = places.collect();
    for place in places {
        scratch::clean(&place);
    }
}
