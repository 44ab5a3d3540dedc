//! User-facing error with a remedy.

/// Error in the user's input or environment, with a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Description of the error, with location and value.
    pub message: String,
    /// Remedy; may be empty.
    pub remedy: String,
}

impl Problem {
    /// Creates a problem from its message and its remedy.
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
