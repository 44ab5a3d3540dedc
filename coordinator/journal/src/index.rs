//! Index of a journal's results by job, with random access to the records.
use super::{error::JournalError, record::RECORD_HEADER};
use crate::event::{Event, Finished};
use protocol::{
    id::JobId,
    wire::{self, WireError},
};
use std::{
    fs::File,
    io,
    os::unix::fs::FileExt,
    path::{Path, PathBuf},
};

/// Index of the results that a journal held when it was read.
#[derive(Debug)]
pub(super) struct Results {
    path: PathBuf,
    file: File,
    index: Index,
}

impl Results {
    /// Creates the index from pairs of a job and the file offset of its result's record body, in file order.
    pub(super) fn new(path: &Path, results: Vec<(JobId, u64)>) -> Result<Self, JournalError> {
        let file = File::open(path).map_err(|source| JournalError::Io {
            doing: "open",
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            file,
            index: Index::new(results),
        })
    }

    /// Returns the jobs that have a result in the journal, in ascending order.
    pub(super) fn jobs(&self) -> impl Iterator<Item = JobId> + '_ {
        self.index.0.iter().map(|(job, _)| *job)
    }

    /// Returns the number of jobs with a result.
    pub(super) const fn len(&self) -> usize {
        self.index.0.len()
    }

    /// Reads the result of a job; `None` if the job has none.
    pub(super) fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        let Some(at) = self.index.find(job) else {
            return Ok(None);
        };
        result_at(&self.file, at).map_err(|error| error.of(&self.path))
    }
}

/// Error of reading one record, without the path of the journal.
pub(super) enum RecordError {
    Io(io::Error),
    Wire(WireError),
}

impl RecordError {
    /// Adds the path of the journal.
    pub(super) fn of(self, path: &Path) -> JournalError {
        match self {
            Self::Io(source) => JournalError::Io {
                doing: "read",
                path: path.to_owned(),
                source,
            },
            Self::Wire(error) => error.into(),
        }
    }
}

/// Reads the result in the record whose body begins at an offset (bytes); `None` if it holds another event.
pub(super) fn result_at(file: &File, at: u64) -> Result<Option<Finished>, RecordError> {
    let mut length = [0; 4];
    // after the mark, before the checksum
    file.read_exact_at(&mut length, at - RECORD_HEADER as u64 + 4)
        .map_err(RecordError::Io)?;
    let mut body = vec![0; (u32::from_le_bytes(length) as usize).min(wire::BODY_LIMIT)];
    file.read_exact_at(&mut body, at).map_err(RecordError::Io)?;
    match wire::decode(&body).map_err(RecordError::Wire)? {
        Event::Finished(finished) => Ok(Some(*finished)),
        Event::Begun { .. }
        | Event::Opened { .. }
        | Event::Joined { .. }
        | Event::Left { .. }
        | Event::Closed
        | Event::Asked(_)
        | Event::Found { .. }
        | Event::Proved { .. }
        | Event::Accounted(_) => Ok(None),
    }
}

/// File offset of the body of each job's result, sorted by job: 16 bytes per result, since there may be
/// millions.
#[derive(Debug)]
struct Index(Vec<(JobId, u64)>);

impl Index {
    /// Creates the index from results in file order; of several results of one job the first counts.
    fn new(mut results: Vec<(JobId, u64)>) -> Self {
        results.sort_unstable();
        results.dedup_by_key(|(job, _)| *job);
        results.shrink_to_fit();
        Self(results)
    }

    fn find(&self, job: JobId) -> Option<u64> {
        let at = self.0.binary_search_by_key(&job, |(job, _)| *job).ok()?;
        self.0.get(at).map(|(_, at)| *at)
    }
}
