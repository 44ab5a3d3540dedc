//! Why a journal cannot be used, with the remedy.
use protocol::wire::{VERSION, WireError};
use std::{io, path::PathBuf};

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// A file cannot be read or written.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// What was tried.
        doing: &'static str,
        /// On what.
        path: PathBuf,
        /// The system's words.
        source: io::Error,
    },
    /// Another coordinator writes this run.
    #[error(
        "the run {} is in use by another coordinator: wait for it, stop it, or choose another run \
         folder",
        folder.display()
    )]
    Locked {
        /// The run's folder.
        folder: PathBuf,
    },
    /// The run was begun with something else.
    #[error(
        "the run {} was begun with another {}; choose another run folder, or repeat the command \
         as it was",
        folder.display(), what.join(", another ")
    )]
    Differs {
        /// The run's folder.
        folder: PathBuf,
        /// What differs, with both values.
        what: Vec<String>,
    },
    /// It was written by another version of this program.
    #[error(
        "the journal {} is of version {found}, and this build reads version {VERSION}: go on with \
         the build that began the run, or choose another run folder",
        path.display()
    )]
    Version {
        /// The journal.
        path: PathBuf,
        /// Its version.
        found: u8,
    },
    /// Every record that says what the run is, is lost, and so is the copy beside the journal.
    #[error(
        "nothing says any more what run the journal {} belongs to (every copy of its first record \
         is lost), so it cannot be continued: choose another run folder",
        path.display()
    )]
    Headless {
        /// The journal.
        path: PathBuf,
    },
    /// Somebody deleted it while the run went on.
    #[error(
        "the journal {} was deleted while the run went on: its results cannot be kept, so the run \
         stops; leave run folders alone until `horsehead` has ended",
        path.display()
    )]
    Deleted {
        /// The journal.
        path: PathBuf,
    },
    /// A record cannot be encoded or decoded.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The journal's thread has ended.
    #[error("the journal is closed")]
    Closed,
}
