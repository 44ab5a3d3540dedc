//! Why a run cannot be exported.
use dispatch::journal::JournalError;
use std::{
    io,
    path::{Path, PathBuf},
};

/// Why a run cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
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
    /// A table cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Table {
        /// Its file.
        path: PathBuf,
        /// The library's words.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Something else is where the export is to go.
    #[error("{} is there already, and is no export of a run in this form", path.display())]
    Foreign {
        /// The file or folder.
        path: PathBuf,
    },
    /// The journal cannot be read.
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
