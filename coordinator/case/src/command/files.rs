//! Reading of the files that travel with a case to the workers.
use crate::{
    document::{Document, DocumentStep},
    error::CaseError,
};
use protocol::{
    external::MOST_BYTES,
    file::{File, is_below},
};
use std::{
    fs, io,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// Maximum number of files that a case may send to the workers.
const MOST_FILES: usize = 10_000;

/// Reads the files and folders that a case names, sorted by path and without duplicates.
///
/// # Errors
/// Returns an error for a path that is outside the case's folder, does not exist, or is neither file nor
/// folder, and if the limits on number or total size are exceeded.
pub(super) fn read(
    document: &Document,
    folder: &Path,
    named: &[PathBuf],
) -> Result<Vec<File>, CaseError> {
    let mut all = Vec::new();
    let mut bytes = 0;
    for (index, path) in named.iter().enumerate() {
        let refused = |problem: &str, help: &str| {
            let keys = [
                DocumentStep::Key("model"),
                DocumentStep::Key("files"),
                DocumentStep::Index(index),
            ];
            let value = format!("\"{}\"", path.display());
            document.field(&keys, value, problem, help)
        };
        if !is_below(path) {
            return Err(refused(
                "a file or folder below the case's own",
                "copy the file into the case's folder, or install it on the workers and refer to it in their allow-list entry",
            ));
        }
        if let Err(error) = add(folder, path, &mut all, &mut bytes) {
            return Err(refused(
                &format!(
                    "files that can be read, of at most {} MiB together ({error})",
                    MOST_BYTES >> 20
                ),
                "correct the name; install large files on the workers and refer to them in the arguments of the workers' allow-list entry",
            ));
        }
    }
    all.sort_by(|a, b| a.path.cmp(&b.path));
    all.dedup_by(|a, b| a.path == b.path);
    Ok(all)
}

fn add(folder: &Path, path: &Path, all: &mut Vec<File>, bytes: &mut usize) -> io::Result<()> {
    let full = folder.join(path);
    let found = fs::symlink_metadata(&full)
        .map_err(|error| io::Error::other(format!("{}: {error}", path.display())))?;
    if found.is_dir() {
        let mut entries = fs::read_dir(&full)?.collect::<io::Result<Vec<_>>>()?;
        entries.sort_by_key(fs::DirEntry::file_name);
        return entries
            .iter()
            .try_for_each(|entry| add(folder, &path.join(entry.file_name()), all, bytes));
    }
    if !found.is_file() {
        let problem = format!(
            "{} is neither a file nor a folder; symbolic links cannot be sent to workers",
            path.display()
        );
        return Err(io::Error::other(problem));
    }
    let length = usize::try_from(found.len()).unwrap_or(usize::MAX);
    *bytes = bytes.saturating_add(length);
    if *bytes > MOST_BYTES || all.len() >= MOST_FILES {
        return Err(io::Error::other(format!(
            "the limit on number or total size of the files is exceeded at {}",
            path.display()
        )));
    }
    let Some(name) = path.to_str() else {
        return Err(io::Error::other("a file name is not valid UTF-8"));
    };
    all.push(File {
        path: name.to_owned(),
        content: fs::read(&full)?,
        executable: found.permissions().mode() & 0o100 != 0,
    });
    Ok(())
}
