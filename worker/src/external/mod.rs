//! Models that are programs of somebody's own: files in, a process, files out.
//!
//! ```text
//! values -> templates (fill) -> folder (scratch) -> process (run) -> readings -> curves (gather)
//! ```
//!
//! What may be started is this machine's own decision: a list that a case can only choose an entry of
//! (`exchange::allow`). Nothing here knows what the numbers mean.
mod fill;
mod gather;
mod model;
mod run;
mod scratch;
mod simulator;
pub mod start;

pub use simulator::Externals;
