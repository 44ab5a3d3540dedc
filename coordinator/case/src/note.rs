//! Remarks on a case that are not errors, for the user's information.
use std::{fmt, path::PathBuf};

/// Remark on a file of a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Path of the file that the remark concerns.
    pub path: PathBuf,
    /// Text of the remark, one sentence.
    pub text: String,
}

impl fmt::Display for Note {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{}: {}", self.path.display(), self.text)
    }
}
