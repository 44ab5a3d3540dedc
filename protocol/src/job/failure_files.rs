//! Files left in the folder of a failed run, transmitted for diagnosis elsewhere.
use crate::file::File;
use serde::{Deserialize, Serialize};

/// Files in the folder of a failed run, without those that the case supplied.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureFiles {
    /// Files left by the failed run, or the ends of long ones, small enough to be transmitted.
    pub files: Vec<File>,
    /// Files or other folder entries that were not transmitted as a whole because they are too long or not
    /// regular files.
    pub shortened: Vec<TruncatedFile>,
}

/// File of a failed run that was transmitted in part or not at all.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TruncatedFile {
    /// Path of the file relative to the run's folder.
    pub path: String,
    /// Length of the file (bytes).
    pub bytes: u64,
    /// Number of bytes at the end of the file that were transmitted.
    pub kept: u64,
}

impl FailureFiles {
    /// Empty set of files, for a run whose folder is not known.
    pub const NONE: Self = Self {
        files: Vec::new(),
        shortened: Vec::new(),
    };

    /// Returns whether no file of the run's folder is recorded.
    pub const fn is_empty(&self) -> bool {
        self.files.is_empty() && self.shortened.is_empty()
    }
}
