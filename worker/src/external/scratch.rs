//! Working folder of one evaluation: created, filled with the case's files, removed.
//!
//! A file in the folder stays locked while its process lives. The folder of a killed process is thereby
//! recognised in any PID namespace, and removed by the next process.
use exchange::allow::AllowEntry;
use protocol::file::{File, is_below};
use std::{
    fs::{self, OpenOptions},
    io,
    os::unix::fs::{DirBuilderExt, OpenOptionsExt},
    path::{Path, PathBuf},
    process,
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

const PREFIX: &str = "horsehead-";

/// Name of the file in a working folder that is locked while the folder is in use. `KEPT` is the name of the
/// file that marks a folder to be kept for inspection.
pub(super) const LOCK: &str = "lock";
const KEPT: &str = "kept";
/// Name of the subfolder of a working folder in which the program runs.
pub(super) const WORK: &str = "work";
/// Age up to which a working folder without a lock file counts as still being created.
const NEW: Duration = Duration::from_mins(1);

/// Counter from which the working folders of this process get distinct names.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Working folder of one evaluation.
#[derive(Debug)]
pub(super) struct Scratch {
    root: PathBuf,
    /// Lock file of the working folder, locked while the folder is in use.
    _lock: fs::File,
    /// Whether the working folder is kept for inspection when this value is dropped.
    kept: bool,
}

/// Returns the directory in which the working folders for an allowed program are created.
pub(super) fn place(entry: &AllowEntry) -> PathBuf {
    entry.folder.clone().unwrap_or_else(std::env::temp_dir)
}

impl Scratch {
    /// Creates a new working folder and locks it.
    pub(super) fn new(place: &Path) -> io::Result<Self> {
        let make = |path: &Path| fs::DirBuilder::new().mode(0o700).create(path);
        let root = loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let root = place.join(format!("{PREFIX}{}-{number}", process::id()));
            match make(&root) {
                // a process of this number, in another namespace or another time
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                made => break made.map(|()| root)?,
            }
        };
        let lock = fs::File::create(root.join(LOCK))?;
        lock.lock()?;
        let scratch = Self {
            root,
            _lock: lock,
            kept: false,
        };
        make(&scratch.work())?;
        Ok(scratch)
    }

    /// Returns the folder in which the program runs.
    pub(super) fn work(&self) -> PathBuf {
        self.root.join(WORK)
    }

    /// Returns the path of the file that receives the program's standard output and error.
    pub(super) fn output_path(&self) -> PathBuf {
        self.root.join("output")
    }

    /// Writes the case's files into the program's working directory.
    pub(super) fn unpack(&self, files: &[File]) -> io::Result<()> {
        for file in files {
            let mode = if file.executable { 0o700 } else { 0o600 };
            self.write(&file.path, &file.content, mode)?;
        }
        Ok(())
    }

    /// Writes a file below the program's working directory; a path that leads elsewhere is refused.
    pub(super) fn write(&self, path: &str, content: &[u8], mode: u32) -> io::Result<()> {
        let target = self.inside(path)?;
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut options = OpenOptions::new();
        let mut file = options
            .write(true)
            .create(true)
            .truncate(true)
            .mode(mode)
            .open(&target)
            .map_err(|error| io::Error::other(format!("{path}: {error}")))?;
        io::Write::write_all(&mut file, content)
    }

    /// Returns the absolute path of a file below the program's working directory; a path that leads elsewhere
    /// is refused.
    pub(super) fn inside(&self, path: &str) -> io::Result<PathBuf> {
        if !is_below(Path::new(path)) {
            return Err(io::Error::other(format!(
                "`{path}` does not lie below the program's folder"
            )));
        }
        Ok(self.work().join(path))
    }

    /// Returns the path of the working folder, which contains lock, output and the program's directory.
    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// Returns the total size of the working folder's contents (bytes).
    pub(super) fn bytes(&self) -> u64 {
        bytes(&self.root)
    }

    /// Marks the folder as kept for inspection, and returns its path.
    pub(super) fn keep(&mut self) -> &Path {
        self.kept = true;
        // a sign for whoever cleans up
        drop(fs::write(self.root.join(KEPT), ""));
        &self.root
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if !self.kept
            && let Err(error) = remove(&self.root)
        {
            tracing::warn!("{} stays: {error}", self.root.display());
        }
    }
}

fn bytes(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let each = entries.map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => bytes(&entry.path()),
        Ok(found) => found.len(),
        // it has just gone
        Err(_) => 0,
    });
    each.sum()
}

/// Removes the folders of processes that no longer exist.
pub(super) fn clean(place: &Path) {
    let entries = fs::read_dir(place).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| {
            let numbers = name
                .strip_prefix(PREFIX)
                .and_then(|rest| rest.split_once('-'));
            numbers.is_some_and(|(owner, number)| {
                [owner, number]
                    .iter()
                    .all(|part| part.parse::<u64>().is_ok())
            })
        });
        let path = entry.path();
        if is_ours && !path.join(KEPT).exists() && is_abandoned(&path) {
            // another user's stays
            drop(remove(&path));
        }
    }
}

/// Removes a folder, its lock file last: if this process is killed meanwhile, the next one still recognises
/// the folder as abandoned.
fn remove(root: &Path) -> io::Result<()> {
    for entry in fs::read_dir(root)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else if entry.file_name() != LOCK {
            fs::remove_file(entry.path())?;
        }
    }
    fs::remove_dir_all(root)
}

/// Returns whether a working folder is abandoned: its lock is free, or it has no lock file and is not new.
fn is_abandoned(folder: &Path) -> bool {
    if let Ok(lock) = fs::File::open(folder.join(LOCK)) {
        return lock.try_lock().is_ok();
    }
    let made = fs::metadata(folder).and_then(|found| found.modified()).ok();
    let age = made.and_then(|made| made.elapsed().ok());
    age.is_some_and(|age| age > NEW)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_outside_and_nothing_stays() {
        let place = tempfile::tempdir().unwrap();
        let root = {
            let scratch = Scratch::new(place.path()).unwrap();
            for bad in ["../x", "/etc/x", "a/../../x", "", "."] {
                let error = scratch.write(bad, b"", 0o600).unwrap_err().to_string();
                assert!(error.contains("below"), "{bad}: {error}");
            }
            scratch.write("a/b", b"12345", 0o600).unwrap();
            assert_eq!(scratch.bytes(), 5);
            scratch.root.clone()
        };
        assert!(!root.exists());
    }

    #[test]
    fn what_a_killed_process_left_is_removed_and_what_is_kept_stays() {
        let place = tempfile::tempdir().unwrap();
        let make = |name: &str| {
            let path = place.path().join(name);
            fs::create_dir(&path).unwrap();
            path
        };
        let [left, kept, other, new] = [
            make("horsehead-7-0"),
            make("horsehead-7-1"),
            make("horsehead-x"),
            make("horsehead-7-2"),
        ];
        for folder in [&left, &kept] {
            fs::write(folder.join(LOCK), "").unwrap();
        }
        let own = Scratch::new(place.path()).unwrap();
        fs::write(kept.join("kept"), "").unwrap();
        clean(place.path());
        assert_eq!(
            [left, kept, other, new, own.root.clone()].map(|path| path.exists()),
            [false, true, true, true, true]
        );
    }
}
