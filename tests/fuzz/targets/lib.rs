//! Code shared by the fuzz targets: the tested properties and a scratch folder.
pub mod property;

use std::{fs, path::PathBuf, sync::LazyLock};

/// Scratch folder of this process, in memory-backed storage if available.
pub static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let shared = PathBuf::from("/dev/shm");
    let base = if shared.is_dir() { shared } else { std::env::temp_dir() };
    let folder = base.join(format!("horsehead-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a scratch folder");
    folder
});
