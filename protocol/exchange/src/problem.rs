//! Error type for faults in the files of external programs, with the remedy.
use std::fmt;

/// Fault in a file of an external program: position, text found, text allowed, and remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problem {
    /// Name of the faulty file as given by the caller.
    pub file: String,
    /// Line of the fault, from 1; `None` if the fault concerns the whole file.
    pub line: Option<usize>,
    /// Text or value found in the file.
    pub found: String,
    /// Description of the text or value that is allowed there.
    pub allowed: String,
    /// Action that corrects the fault of the file.
    pub remedy: String,
}

impl Problem {
    pub(crate) fn at(
        file: &str,
        line: usize,
        found: impl Into<String>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            file: file.to_owned(),
            line: Some(line),
            found: found.into(),
            allowed: allowed.into(),
            remedy: remedy.into(),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            found,
            allowed,
            remedy,
        } = self;
        write!(to, "{file}")?;
        if let Some(line) = line {
            write!(to, ", line {line}")?;
        }
        write!(to, ": {found}, but it must be {allowed}; {remedy}")
    }
}

/// Shortens a text to 60 characters without control characters, for messages.
pub(crate) fn clip(text: &str) -> String {
    const MOST: usize = 60;
    let plain = text.chars().filter(|letter| !letter.is_control());
    let mut clipped: String = plain.take(MOST).collect();
    if text.chars().nth(MOST).is_some() {
        clipped.push('…');
    }
    clipped
}
