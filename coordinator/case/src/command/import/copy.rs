//! Copying of a control file's folder to the folder of the imported case.
use protocol::external::MOST_BYTES;
use std::{fs, io, path::Path};

/// Copies the contents of a folder; returns the names of the copied entries and notes on those left out.
/// Hidden entries and folders that are themselves cases are skipped, because a case may lie in the folder of
/// its control file.
pub(super) fn copy_contents(from: &Path, to: &Path) -> io::Result<(Vec<String>, Vec<String>)> {
    let (mut names, mut notes, mut bytes) = (Vec::new(), Vec::new(), 0);
    let mut entries = fs::read_dir(from)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    let target = fs::canonicalize(to)?;
    for entry in entries {
        let path = entry.path();
        let Some(name) = entry.file_name().to_str().map(str::to_owned) else {
            notes.push(format!(
                "{} was not copied: its name is not valid UTF-8",
                path.display()
            ));
            continue;
        };
        let is_case = path.join("case.toml").exists()
            || fs::canonicalize(&path).is_ok_and(|own| own == target);
        if name.starts_with('.') || is_case {
            continue;
        }
        if !copy_entry(&path, &to.join(&name), &mut bytes)? {
            notes.push(format!(
                "{name} was not copied: it is neither a file nor a folder, or exceeds the size limit for files sent to workers"
            ));
            continue;
        }
        names.push(name);
    }
    Ok((names, notes))
}

/// Copies a file or folder; returns false if it is neither, or exceeds the size limit for files that travel
/// with a case.
fn copy_entry(from: &Path, to: &Path, bytes: &mut u64) -> io::Result<bool> {
    let found = fs::symlink_metadata(from)?;
    if found.is_dir() {
        fs::create_dir(to)?;
        for entry in fs::read_dir(from)? {
            let entry = entry?;
            if !copy_entry(&entry.path(), &to.join(entry.file_name()), bytes)? {
                fs::remove_dir_all(to)?;
                return Ok(false);
            }
        }
        return Ok(true);
    }
    *bytes += found.len();
    if !found.is_file() || *bytes > MOST_BYTES as u64 {
        *bytes -= found.len();
        return Ok(false);
    }
    fs::copy(from, to)?;
    Ok(true)
}
