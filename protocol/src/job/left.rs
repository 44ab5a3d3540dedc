//! What a failed run left in its folder, for somebody who was not there.
use crate::file::File;
use serde::{Deserialize, Serialize};

/// Files of a failed run, beside those that its case brought along.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Left {
    /// What was small enough to travel.
    pub files: Vec<File>,
    /// What was not, or is no plain file: where it lay, how long it was (bytes), and how many of its last bytes
    /// are among [`Self::files`].
    pub shortened: Vec<Shortened>,
}

/// A file that did not travel as a whole.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shortened {
    /// Where it lay below the folder.
    pub path: String,
    /// Its length (bytes).
    pub bytes: u64,
    /// How many of its last bytes travel (bytes).
    pub kept: u64,
}

impl Left {
    /// Nothing is known of the run's folder.
    pub const NONE: Self = Self {
        files: Vec::new(),
        shortened: Vec::new(),
    };

    /// Whether nothing is known of the run's folder.
    pub const fn is_empty(&self) -> bool {
        self.files.is_empty() && self.shortened.is_empty()
    }
}
