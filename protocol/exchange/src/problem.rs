//! What is wrong with a file, and what to do about it.
use std::fmt;

/// A file that cannot be used as it is.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problem {
    /// The file, as it was named.
    pub file: String,
    /// Its line, from 1, where one is at fault.
    pub line: Option<usize>,
    /// What stands there.
    pub found: String,
    /// What may stand there.
    pub allowed: String,
    /// What to do.
    pub remedy: String,
}

impl Problem {
    /// In a line of a file.
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

/// At most so many characters of a text, for messages.
pub(crate) fn clip(text: &str) -> String {
    const MOST: usize = 60;
    let plain = text.chars().filter(|letter| !letter.is_control());
    let mut clipped: String = plain.take(MOST).collect();
    if text.chars().nth(MOST).is_some() {
        clipped.push('…');
    }
    clipped
}
