//! Remarks about a case that are no errors: what the user should know and may accept.
use std::{fmt, path::PathBuf};

/// One remark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// The file it is about.
    pub path: PathBuf,
    /// What there is to know, in one sentence.
    pub text: String,
}

impl fmt::Display for Note {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{}: {}", self.path.display(), self.text)
    }
}
