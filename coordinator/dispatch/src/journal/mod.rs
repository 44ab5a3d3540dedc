//! The append-only record of a run: what is in it is true, and nothing else is.
//!
//! ```text
//! record:  "HHJ" version | length u32 | crc32 u32 of length and body | body (an encoded Event)
//! ```
//!
//! Each record carries its own mark and checksum, so that a flipped byte, a zeroed block or a
//! torn tail costs the records it touched and no other. What the run *is* stands in the first
//! record, in every later opening's, and in a file of its own ([`HEAD`]): no single damage makes
//! a run impossible to continue. The version is that of the wire, since a record holds what came
//! over it; a journal of another one is refused as such and not taken for damage. Readers are folds
//! over the events ([`fold`]). The writer ([`Journal`]) holds a lock, so that one run has one writer;
//! on a full disk it waits. What the events mean for a run is nobody's business here.
mod differences;
mod error;
mod head;
mod index;
mod open;
mod read;
mod record;
mod recording;
#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod tests;
mod write;

pub use error::JournalError;
pub use open::{Begun, Journal};
pub use read::{Damage, Entry, ReadReport, fold, words};
pub use record::{FILE, HEAD, LOCK, MARK};
pub use recording::{Recording, numbers};
pub use write::Appended;
