//! What cannot be done as it was asked for.

/// Something that cannot be done as it was asked for, and what to do instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// What is wrong, with the place and the value.
    pub message: String,
    /// What to do; may be empty.
    pub remedy: String,
}

impl Problem {
    /// What is wrong, and what to do.
    pub fn new(message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            remedy: remedy.into(),
        }
    }
}

impl std::fmt::Display for Problem {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str(&self.message)
    }
}

impl std::error::Error for Problem {}
