//! Read-only access to a journal, during its run or after its end, without locking or changing it.
use super::{
    error::JournalError,
    index::Results,
    read::{JournalEntry, ReadReport, fold},
};
use crate::event::{Event, Finished};
use protocol::id::{ContentHash, JobId};
use std::path::Path;

/// Snapshot of the results in a journal; records written later are not included.
#[derive(Debug)]
pub struct JournalSnapshot {
    results: Results,
    report: ReadReport,
}

impl JournalSnapshot {
    /// Reads a journal; `heard` is called with every event, in order.
    ///
    /// # Errors
    /// As [`fold`].
    pub fn read(
        path: &Path,
        mut heard: impl FnMut(JournalEntry, Event),
    ) -> Result<Self, JournalError> {
        let mut results = Vec::new();
        let report = fold(path, |entry, event| {
            if let Event::Finished(finished) = &event {
                results.push((finished.job(), entry.at));
            }
            heard(entry, event);
        })?;
        Ok(Self {
            results: Results::new(path, results)?,
            report,
        })
    }

    /// Reads the result of a job; `None` if the job had none when the journal was read.
    ///
    /// # Errors
    /// [`JournalError::Io`] or [`JournalError::Wire`] if the record cannot be read.
    pub fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        self.results.recall(job)
    }

    /// Returns the number of jobs with a result.
    pub const fn len(&self) -> usize {
        self.results.len()
    }

    /// Returns whether no job has a result.
    pub const fn is_empty(&self) -> bool {
        self.results.len() == 0
    }

    /// Returns the number of records read, and the damage found.
    pub const fn report(&self) -> &ReadReport {
        &self.report
    }
}

/// Calls `given` with the number and content hash of a job, for each request and each result in a journal.
///
/// # Errors
/// As [`fold`].
pub fn numbers(path: &Path, mut given: impl FnMut(JobId, ContentHash)) -> Result<(), JournalError> {
    let report = fold(path, |_, event| match event {
        Event::Asked(asked) => given(asked.job, asked.work),
        // of a job whose question was lost to damage the answer is left
        Event::Finished(finished) => given(finished.job(), finished.work),
        Event::Begun { .. }
        | Event::Opened { .. }
        | Event::Joined { .. }
        | Event::Left { .. }
        | Event::Closed
        | Event::Proved { .. }
        | Event::Accounted(_)
        | Event::Found { .. } => {}
    });
    report.map(drop)
}
