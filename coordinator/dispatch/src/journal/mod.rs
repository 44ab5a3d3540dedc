//! Append-only journal of a run, the only source of truth about it.
//!
//! ```text
//! record:  "HHJ" version | length u32 | crc32 u32 of length and body | body (an encoded Event)
//! ```
//!
//! Each record carries its own mark and checksum, so that a flipped byte, a zeroed block or a torn tail costs
//! only the records it touched. The identity of the run stands in the first record, in every later opening's,
//! and in a file of its own ([`HEAD`]), so that no single damage makes a run impossible to continue. The
//! version is that of the wire protocol, since records hold wire messages; a journal with an intact record that this
//! version cannot read is refused and not treated as damaged. Readers are folds over the events ([`fold`]). The
//! writer ([`Journal`]) holds a lock on the file, so that one run has one writer; on a full disk it waits. This module does not interpret what
//! the events mean for a run.
mod differences;
mod error;
mod follow;
mod head;
mod index;
mod open;
mod read;
mod record;
mod recording;
mod recovered;
#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod tests;
mod write;

pub use error::JournalError;
pub use follow::{Growth, JournalFollower};
pub use open::{Journal, OpenedRun, discard};
pub(crate) use read::fold_medium;
pub use read::{Damage, JournalEntry, ReadReport, describe_damage, fold};
pub(crate) use record::record;
pub use record::{FILE, HEAD, LOCK, MARK};
pub use recording::{JournalSnapshot, numbers};
pub(crate) use recovered::RecoveredRun;
pub use write::WriterReport;
