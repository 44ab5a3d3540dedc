//! Append-only journal of a run, the only source of truth about it.
//!
//! ```text
//! record:  "HHJ" version | length u32 | crc32 u32 of length and body | body (an encoded Event)
//! ```
//!
//! Each record carries its own mark and checksum, so that a flipped byte, a zeroed block or a torn tail costs
//! only the records it touched. The identity of the run stands in the first record, in every later opening's,
//! and in a file of its own ([`HEAD`]), so that no single damage makes a run impossible to continue. The journal has
//! a version of its own ([`VERSION`]); one with an intact record that this version cannot read is refused and not
//! treated as damaged. Readers are folds over the [events](event::Event): [`fold`] reads a journal once,
//! [`JournalFollower`] while its run writes it, [`account`] sums how slots spent their time. The writer ([`Journal`])
//! holds a lock on the file, so that one run has one writer; on a full disk it waits. This crate does not interpret
//! what a study found.
pub mod account;
mod answers;
mod differences;
mod entries;
mod error;
pub mod event;
mod follow;
mod head;
mod index;
pub mod job_range;
mod numbers;
mod open;
mod read;
mod record;
mod recovered;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod tests;
mod write;

pub use answers::Answers;
pub use entries::StudyEntries;
pub use error::JournalError;
pub use follow::{Growth, JournalFollower};
pub use numbers::numbers;
pub use open::{Journal, OpenedRun, discard};
pub use read::{Damage, JournalEntry, ReadError, ReadReport, describe_damage, fold, fold_medium};
pub use record::{FILE, HEAD, LOCK, MARK, VERSION, record};
pub use recovered::RecoveredRun;
pub use write::WriterReport;
