//! Working folder of one evaluation: created in this user's own folder, filled with the case's files, removed.
//!
//! A file in the folder stays locked while its process lives. The folder of a killed process is thereby
//! recognised in any PID namespace, and removed by the next process.
use super::own_folder::{self, OpenFolder};
use exchange::allow::AllowEntry;
use protocol::file::{File, is_below};
use std::{
    ffi::{CStr, CString, OsStr},
    fs::{self, OpenOptions},
    io,
    os::unix::{
        ffi::OsStrExt,
        fs::{DirBuilderExt, OpenOptionsExt},
    },
    path::{Path, PathBuf},
    process,
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

const PREFIX: &str = "run-";

/// Name of the file in a working folder that is locked while the folder is in use.
pub(super) const LOCK: &str = "lock";
const LOCK_NAME: &CStr = c"lock";
/// Name of the file that marks a working folder to be kept for inspection.
const KEPT: &CStr = c"kept";
/// Name of the subfolder of a working folder in which the program runs.
pub(super) const WORK: &str = "work";
/// Age up to which a working folder without a lock file counts as still being created.
const NEW: Duration = Duration::from_mins(1);

/// Counter from which the working folders of this process get distinct names.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Working folder of one evaluation.
#[derive(Debug)]
pub(super) struct ScratchFolder {
    root: PathBuf,
    /// Lock file of the working folder, locked while the folder is in use.
    _lock: fs::File,
    /// Whether the working folder is kept for inspection when this value is dropped.
    kept: bool,
}

/// Returns the parent of the own folder in which the working folders for an allowed program are created.
pub(super) fn parent(entry: &AllowEntry) -> PathBuf {
    entry.folder.clone().unwrap_or_else(std::env::temp_dir)
}

impl ScratchFolder {
    /// Creates a new working folder in the own folder below `parent` and locks it.
    pub(super) fn new(parent: &Path) -> io::Result<Self> {
        let place = own_folder::below(parent)?;
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
        drop(fs::write(
            self.root.join(OsStr::from_bytes(KEPT.to_bytes())),
            "",
        ));
        &self.root
    }
}

impl Drop for ScratchFolder {
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

/// Removes the folders of processes that no longer exist from the own folder below `parent`.
pub(super) fn clean(parent: &Path) {
    let own = own_folder::existing(parent).and_then(|path| OpenFolder::open(&path).ok());
    let Some(own) = own else {
        return;
    };
    let names = own.names(|name| name.to_bytes().starts_with(PREFIX.as_bytes()));
    for name in names.unwrap_or_default() {
        let is_left = own
            .folder(&name)
            .is_ok_and(|folder| !folder.has(KEPT) && is_abandoned(&folder));
        if is_left {
            // it is tried again by the next process
            drop(own.remove(&name, LOCK_NAME));
        }
    }
}

/// Removes a working folder.
fn remove(root: &Path) -> io::Result<()> {
    let (Some(own), Some(name)) = (root.parent(), root.file_name()) else {
        return Err(io::ErrorKind::NotFound.into());
    };
    let name = CString::new(name.as_bytes())?;
    OpenFolder::open(own)?.remove(&name, LOCK_NAME)
}

/// Returns whether a working folder is abandoned: its lock is free, or it has no lock file and is not new.
fn is_abandoned(folder: &OpenFolder) -> bool {
    if let Ok(lock) = folder.file(LOCK_NAME) {
        return lock.try_lock().is_ok();
    }
    let made = folder.attributes().map(|found| found.st_mtime);
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let (Ok(made), Ok(now)) = (made.map(u64::try_from), now) else {
        return false;
    };
    made.is_ok_and(|made| now.saturating_sub(Duration::from_secs(made)) > NEW)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_outside_and_nothing_stays() {
        let place = tempfile::tempdir().unwrap();
        let root = {
            let scratch = ScratchFolder::new(place.path()).unwrap();
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
        let own_folder = own_folder::below(place.path()).unwrap();
        let make = |name: &str| {
            let path = own_folder.join(name);
            fs::create_dir(&path).unwrap();
            path
        };
        let [left, kept, other, new] = ["run-7-0", "run-7-1", "x", "run-7-2"].map(make);
        for folder in [&left, &kept] {
            fs::write(folder.join(LOCK), "").unwrap();
        }
        let own = ScratchFolder::new(place.path()).unwrap();
        fs::write(kept.join("kept"), "").unwrap();
        clean(place.path());
        assert_eq!(
            [left, kept, other, new, own.root.clone()].map(|path| path.exists()),
            [false, true, true, true, true]
        );
    }
}
