//! Error type of the export of a run.
use journal::JournalError;
use std::{
    io,
    path::{Path, PathBuf},
};

/// Error of the export of a run.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file of the export cannot be read or written.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// Failed file operation, for example `write`.
        doing: &'static str,
        /// File or folder on which the operation failed.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A row or table of the export cannot be written in its file format.
    #[error("cannot write {}: {source}", path.display())]
    Table {
        /// File of the table that cannot be written.
        path: PathBuf,
        /// Error of the file format library.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The target of the export exists and is not an export in this format.
    #[error("{} already exists and is not an export of a run in this format", path.display())]
    Foreign {
        /// Existing file or folder.
        path: PathBuf,
    },
    /// The run's journal, from which the export is made, cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

impl StoreError {
    fn io(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io {
            doing,
            path,
            source,
        }
    }

    pub(super) fn writing(path: &Path) -> impl FnOnce(io::Error) -> Self {
        Self::io("write", path)
    }

    pub(super) fn reading(path: &Path) -> impl FnOnce(io::Error) -> Self {
        Self::io("read", path)
    }

    pub(super) fn table(
        path: &Path,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> Self {
        Self::Table {
            path: path.to_owned(),
            source: source.into(),
        }
    }
}
