//! What cannot be planned, and what to do about it.

/// Something that was asked for cannot be planned.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct NodeError {
    /// What is wrong, with the place and the value.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl NodeError {
    pub(super) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: help.into(),
        }
    }
}
