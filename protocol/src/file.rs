//! Files that travel: those of a case, and what a failed run leaves.
use serde::{Deserialize, Serialize};
use std::path::{Component, Path};

/// A file with its bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct File {
    /// Where it lies below the folder that it belongs to, with `/` between folders.
    pub path: String,
    /// Its bytes.
    #[serde(with = "serde_bytes")]
    pub content: Vec<u8>,
    /// Whether it may be executed.
    pub executable: bool,
}

/// Whether a path leads to something below a folder, and nowhere else.
pub fn is_below(path: &Path) -> bool {
    let mut parts = path.components();
    !path.as_os_str().is_empty() && parts.all(|part| matches!(part, Component::Normal(_)))
}
