//! The files that travel with a case.
use crate::{
    document::{Document, Step},
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

/// Most files of a case.
const MOST_FILES: usize = 10_000;

/// Reads the files and folders that a case names, in the order of their paths.
///
/// # Errors
/// One that does not lie below the case's folder, is not there, is neither file nor folder, or more than what
/// may travel.
pub(super) fn read(
    document: &Document,
    folder: &Path,
    named: &[PathBuf],
) -> Result<Vec<File>, CaseError> {
    let mut all = Vec::new();
    let mut bytes = 0;
    for (index, path) in named.iter().enumerate() {
        let refused = |problem: &str, help: &str| {
            let way = [Step::Key("model"), Step::Key("files"), Step::Index(index)];
            let value = format!("\"{}\"", path.display());
            document.field(&way, value, problem, help)
        };
        if !is_below(path) {
            return Err(refused(
                "a file or folder below the case's own",
                "copy it there, or leave it on the workers and name it in their entry",
            ));
        }
        if let Err(error) = add(folder, path, &mut all, &mut bytes) {
            return Err(refused(
                &format!(
                    "files that can be read, of at most {} MiB together ({error})",
                    MOST_BYTES >> 20
                ),
                "correct the name; what is large stays on the workers, and their entry's arguments name it",
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
            "{} is neither file nor folder: links do not travel",
            path.display()
        );
        return Err(io::Error::other(problem));
    }
    let length = usize::try_from(found.len()).unwrap_or(usize::MAX);
    *bytes = bytes.saturating_add(length);
    if *bytes > MOST_BYTES || all.len() >= MOST_FILES {
        return Err(io::Error::other(format!("more with {}", path.display())));
    }
    let Some(name) = path.to_str() else {
        return Err(io::Error::other("a name that is no text"));
    };
    all.push(File {
        path: name.to_owned(),
        content: fs::read(&full)?,
        executable: found.permissions().mode() & 0o100 != 0,
    });
    Ok(())
}
