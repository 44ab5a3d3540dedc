//! The folder of one evaluation: made, filled with the case's files, removed.
//!
//! Its name begins with the number of the process that made it, so that what a killed one leaves is found and
//! removed by the next.
use exchange::allow::Entry;
use protocol::external::File;
use std::{
    fs::{self, OpenOptions},
    io,
    os::unix::fs::{DirBuilderExt, OpenOptionsExt},
    path::{Component, Path, PathBuf},
    process,
    sync::atomic::{AtomicU64, Ordering},
};

/// Begin of the names of all such folders.
const PREFIX: &str = "horsehead-";

/// Numbers the folders of this process.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// A folder for one evaluation.
#[derive(Debug)]
pub(super) struct Scratch {
    root: PathBuf,
    /// Whether it stays where it is.
    kept: bool,
}

/// Where an entry's folders are made.
pub(super) fn place(entry: &Entry) -> PathBuf {
    entry.folder.clone().unwrap_or_else(std::env::temp_dir)
}

impl Scratch {
    /// Makes one.
    pub(super) fn new(place: &Path) -> io::Result<Self> {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let root = place.join(format!("{PREFIX}{}-{number}", process::id()));
        // of an earlier process of this number
        drop(fs::remove_dir_all(&root));
        let make = |path: &Path| fs::DirBuilder::new().mode(0o700).create(path);
        make(&root)?;
        let scratch = Self { root, kept: false };
        make(&scratch.work())?;
        Ok(scratch)
    }

    /// Where the program works.
    pub(super) fn work(&self) -> PathBuf {
        self.root.join("work")
    }

    /// What it says on its outputs.
    pub(super) fn said(&self) -> PathBuf {
        self.root.join("output")
    }

    /// Writes the case's files.
    pub(super) fn unpack(&self, files: &[File]) -> io::Result<()> {
        for file in files {
            let mode = if file.executable { 0o700 } else { 0o600 };
            self.write(&file.path, &file.content, mode)?;
        }
        Ok(())
    }

    /// Writes a file below the folder and nowhere else.
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

    /// A path below the folder.
    pub(super) fn inside(&self, path: &str) -> io::Result<PathBuf> {
        let plain = Path::new(path)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if path.is_empty() || !plain {
            return Err(io::Error::other(format!(
                "`{path}` does not lie below the program's folder"
            )));
        }
        Ok(self.work().join(path))
    }

    /// How much is in it (bytes).
    pub(super) fn bytes(&self) -> u64 {
        bytes(&self.root)
    }

    /// Leaves it where it is, for somebody to look into.
    pub(super) fn keep(&mut self) -> &Path {
        self.kept = true;
        // a sign for whoever cleans up
        drop(fs::write(self.root.join("kept"), ""));
        &self.root
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if !self.kept
            && let Err(error) = fs::remove_dir_all(&self.root)
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

/// Removes what processes left that are no more.
pub(super) fn clean(place: &Path) {
    let entries = fs::read_dir(place).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let owner = name.to_str().and_then(|name| {
            let (owner, number) = name.strip_prefix(PREFIX)?.split_once('-')?;
            number.parse::<u64>().ok()?;
            owner.parse::<u32>().ok()
        });
        let is_over =
            owner.is_some_and(|owner| !Path::new("/proc").join(owner.to_string()).exists());
        if is_over && !entry.path().join("kept").exists() {
            // another user's stays
            drop(fs::remove_dir_all(entry.path()));
        }
    }
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
        // no process has the largest number
        let [left, kept, own, other] = [
            make("horsehead-4294967295-0"),
            make("horsehead-4294967295-1"),
            make(&format!("horsehead-{}-7", process::id())),
            make("horsehead-x"),
        ];
        fs::write(kept.join("kept"), "").unwrap();
        clean(place.path());
        assert_eq!(
            [left, kept, own, other].map(|path| path.exists()),
            [false, true, true, true]
        );
    }
}
