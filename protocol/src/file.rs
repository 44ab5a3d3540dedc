//! Files sent in messages: those of a case, and those left by a failed run.
use serde::{Deserialize, Serialize};
use std::path::{Component, Path};

/// File with its content.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct File {
    /// Path relative to the folder that the file belongs to, with `/` as separator.
    pub path: String,
    /// Bytes of the file.
    #[serde(with = "serde_bytes")]
    pub content: Vec<u8>,
    /// Whether the file is executable.
    pub executable: bool,
}

/// Returns whether a relative path stays below its folder, i.e. is not empty and contains neither `..` nor a
/// root.
pub fn is_below(path: &Path) -> bool {
    let mut parts = path.components();
    !path.as_os_str().is_empty() && parts.all(|part| matches!(part, Component::Normal(_)))
}
