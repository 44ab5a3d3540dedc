//! What the targets share: the properties, and a place for files.
pub mod property;

use std::{fs, path::PathBuf, sync::LazyLock};

/// A folder of this process, in memory-backed storage where there is such.
pub static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let shared = PathBuf::from("/dev/shm");
    let base = if shared.is_dir() { shared } else { std::env::temp_dir() };
    let folder = base.join(format!("horsehead-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a scratch folder");
    folder
});
