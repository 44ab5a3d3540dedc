//! Paths of raw files relative to the mapping that names them.
use std::path::{Component, Path, PathBuf};

/// Returns the path of a file that a mapping names, without `..` where it can be.
pub(super) fn beside(mapping: &Path, file: &Path) -> PathBuf {
    let mut path = mapping
        .parent()
        .unwrap_or_else(|| Path::new("."))
        .to_owned();
    for part in file.components() {
        if part == Component::ParentDir && path.file_name().is_some() {
            path.pop();
        } else {
            path.push(part);
        }
    }
    // the folder above a symbolic link is not that of its target
    if path.exists() {
        return path;
    }
    mapping
        .parent()
        .unwrap_or_else(|| Path::new("."))
        .join(file)
}

/// Returns a path relative to a folder, with `..` where it must; the path itself where either is unknown.
pub(super) fn relative(path: &Path, folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    // the folder of a new case may not exist yet
    let known = folder.ancestors().find_map(|one| {
        let real = one.canonicalize().ok()?;
        Some(real.join(folder.strip_prefix(one).ok()?))
    });
    let (Ok(path), Some(folder)) = (path.canonicalize(), known) else {
        return path.to_owned();
    };
    let shared = path.components().zip(folder.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| "..");
    let down = path.components().skip(shared);
    up.map(PathBuf::from)
        .chain(down.map(|part| PathBuf::from(part.as_os_str())))
        .collect()
}
