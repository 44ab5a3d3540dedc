//! What reports show of models that are programs of the user's own, the kind `command`.
pub(crate) mod kind;
mod report;
