//! Reading of a journal while its run writes it, without locking or changing it.
use super::{
    error::JournalError,
    read::{Damage, JournalEntry, fold_from},
};
use crate::event::Event;
use std::{
    fs, io,
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
};

/// Change of a journal since it was last read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// No record was added.
    Unchanged,
    /// Records were added.
    Grown,
    /// The journal is missing or empty: it is not yet written, or the run folder was deleted.
    Missing,
    /// The journal was replaced by another one; the next reading begins at its first record.
    Replaced,
}

/// Reader of a growing journal: each reading continues where the last one ended.
#[derive(Debug)]
pub struct JournalFollower {
    path: PathBuf,
    /// File offset of the end of the last readable record (bytes).
    end: u64,
    /// Length of the file when it was last read (bytes).
    length: u64,
    /// Inode of the file, which tells a replaced journal; `None` before the first reading.
    inode: Option<u64>,
    damage: Vec<Damage>,
}

impl JournalFollower {
    /// Creates a follower of a journal, which need not exist yet.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            end: 0,
            length: 0,
            inode: None,
            damage: Vec::new(),
        }
    }

    /// Calls `apply` for each event that was written since the last call, in order. An unfinished record at
    /// the end of the file is left for the next call.
    ///
    /// # Errors
    /// [`JournalError::Io`] if the file cannot be read, [`JournalError::Version`] if another version wrote it.
    pub fn read(&mut self, apply: impl FnMut(JournalEntry, Event)) -> Result<Growth, JournalError> {
        let state = match fs::metadata(&self.path) {
            Ok(state) => state,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Growth::Missing),
            Err(source) => {
                let path = self.path.clone();
                let doing = "read";
                return Err(JournalError::Io {
                    doing,
                    path,
                    source,
                });
            }
        };
        let is_other = |inode| state.ino() != inode || state.len() < self.end;
        if self.inode.is_some_and(is_other) {
            *self = Self::new(&self.path);
            return Ok(Growth::Replaced);
        }
        if state.len() == 0 {
            return Ok(Growth::Missing);
        }
        if state.len() == self.length {
            return Ok(Growth::Unchanged);
        }
        self.inode = Some(state.ino());
        let before = self.end;
        let report = fold_from(&self.path, before, apply)?;
        self.length = state.len();
        self.end = report.end;
        // what is torn may be a record that is being written
        let certain = report.damage.into_iter().filter(|damage| !damage.torn);
        self.damage.extend(certain);
        Ok(if self.end > before {
            Growth::Grown
        } else {
            Growth::Unchanged
        })
    }

    /// Returns the file offset of the end of the last record that was read (bytes).
    pub const fn position(&self) -> u64 {
        self.end
    }

    /// Returns the stretches of the journal that cannot be read and are followed by readable records.
    pub fn damage(&self) -> &[Damage] {
        &self.damage
    }
}
