//! Errors of opening, reading and writing a journal, with the remedy in the message.
use crate::record::VERSION;
use protocol::wire::WireError;
use std::{io, path::PathBuf};

/// Reason why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// A file cannot be read or written.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// Verb of the failed operation.
        doing: &'static str,
        /// File or folder of the failed operation.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Another coordinator holds the run's lock.
    #[error(
        "the run {} is in use by another coordinator: wait for it, stop it, or choose another run \
         folder",
        folder.display()
    )]
    Locked {
        /// Folder of the locked run.
        folder: PathBuf,
    },
    /// The run was begun with another command, case or settings.
    #[error(
        "the run {} was begun with another {}; choose another run folder, or repeat the original \
         command",
        folder.display(), what.join(", another ")
    )]
    Differs {
        /// Folder of the run that was begun otherwise.
        folder: PathBuf,
        /// Descriptions of the differences between the existing and the requested run, with both values.
        what: Vec<String>,
    },
    /// The journal was written by another version of this program.
    #[error(
        "the journal {} is of version {found}, and this build reads version {VERSION}: continue with \
         the build that began the run, or choose another run folder",
        path.display()
    )]
    Version {
        /// Path of the journal.
        path: PathBuf,
        /// Version of the journal.
        found: u8,
    },
    /// The journal holds an intact record of this version that this build cannot decode.
    #[error(
        "the record at offset {at} of the journal {} is intact, but this build cannot decode it; nothing was \
         changed: continue with the build that began the run, or choose another run folder",
        path.display()
    )]
    Undecodable {
        /// Path of the journal.
        path: PathBuf,
        /// Offset of the record (bytes).
        at: u64,
    },
    /// Every record of the journal that identifies the run is lost, and so is the copy of the first record.
    #[error(
        "the run of the journal {} cannot be identified, because every copy of its first record is \
         lost, so it cannot be continued: choose another run folder",
        path.display()
    )]
    Unidentified {
        /// Path of the journal without identification.
        path: PathBuf,
    },
    /// The journal was deleted during the run, or another file took its place.
    #[error(
        "the journal {} was deleted or replaced during the run: its results cannot be kept, so the run \
         stops; leave run folders alone until `horsehead` has ended",
        path.display()
    )]
    Deleted {
        /// Path of the journal.
        path: PathBuf,
    },
    /// The study found something else than an earlier process of the run.
    #[error(
        "entry {number} of the study differs from that in the journal {}: the run was begun with another build or on other \
         data; continue with the build that began it, or choose another run folder",
        path.display()
    )]
    EntryDiffers {
        /// Path of the journal.
        path: PathBuf,
        /// Number of the entry.
        number: u64,
    },
    /// A record cannot be encoded or decoded.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The thread that writes the journal has ended.
    #[error("the journal is closed")]
    Closed,
}
