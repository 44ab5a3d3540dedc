//! Reading of a journal while its run writes it, without locking or changing it.
use super::{
    error::JournalError,
    index::result_at,
    read::{Damage, JournalEntry, fold_from},
};
use crate::event::{Event, Finished};
use protocol::id::JobId;
use std::{
    collections::BTreeMap,
    fs::{self, File},
    io,
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
    file: Option<File>,
    /// File offset of the end of the last readable record (bytes).
    end: u64,
    /// Length of the file when it was last read (bytes).
    length: u64,
    /// Inode of the file, which tells a replaced journal.
    inode: u64,
    /// File offset of the body of each job's first result.
    results: BTreeMap<JobId, u64>,
    damage: Vec<Damage>,
}

impl JournalFollower {
    /// Creates a follower of a journal, which need not exist yet.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            file: None,
            end: 0,
            length: 0,
            inode: 0,
            results: BTreeMap::new(),
            damage: Vec::new(),
        }
    }

    /// Calls `apply` for each event that was written since the last call, in order. An unfinished record at
    /// the end of the file is left for the next call.
    ///
    /// # Errors
    /// [`JournalError::Io`] if the file cannot be read, [`JournalError::Version`] if another version wrote it.
    pub fn read(
        &mut self,
        mut apply: impl FnMut(JournalEntry, &Event),
    ) -> Result<Growth, JournalError> {
        let state = match fs::metadata(&self.path) {
            Ok(state) => state,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Growth::Missing),
            Err(source) => return Err(self.failed("read", source)),
        };
        if self.file.is_some() && (state.ino() != self.inode || state.len() < self.end) {
            *self = Self::new(&self.path);
            return Ok(Growth::Replaced);
        }
        if state.len() == 0 {
            return Ok(Growth::Missing);
        }
        if state.len() == self.length {
            return Ok(Growth::Unchanged);
        }
        if self.file.is_none() {
            self.file = Some(File::open(&self.path).map_err(|error| self.failed("open", error))?);
            self.inode = state.ino();
        }
        let before = self.end;
        let results = &mut self.results;
        let report = fold_from(&self.path, before, |entry, event| {
            if let Event::Finished(finished) = &event {
                results.entry(finished.job()).or_insert(entry.at);
            }
            apply(entry, &event);
        })?;
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

    fn failed(&self, doing: &'static str, source: io::Error) -> JournalError {
        JournalError::Io {
            doing,
            path: self.path.clone(),
            source,
        }
    }

    /// Returns whether a job has a result in what was read.
    pub fn has_result(&self, job: JobId) -> bool {
        self.results.contains_key(&job)
    }

    /// Reads the result of a job; `None` if the job has none in what was read.
    ///
    /// # Errors
    /// [`JournalError::Io`] or [`JournalError::Wire`] if the record cannot be read.
    pub fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        match (&self.file, self.results.get(&job)) {
            (Some(file), Some(at)) => result_at(file, *at).map_err(|error| error.of(&self.path)),
            _ => Ok(None),
        }
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
