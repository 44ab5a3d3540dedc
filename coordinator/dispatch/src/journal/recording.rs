//! A journal for reading alone: while its run goes on or after its end, and without a trace.
use super::{
    error::JournalError,
    index::Results,
    read::{Entry, ReadReport, fold},
};
use protocol::{
    event::{Event, Finished},
    id::{ContentHash, JobId},
};
use std::path::Path;

/// What a journal held at a moment. Whatever is written to it later does not change it.
#[derive(Debug)]
pub struct Recording {
    results: Results,
    report: ReadReport,
}

impl Recording {
    /// Reads a journal; `heard` is given every event, in order.
    ///
    /// # Errors
    /// As [`fold`].
    pub fn read(path: &Path, mut heard: impl FnMut(Entry, Event)) -> Result<Self, JournalError> {
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

    /// The result of a job; `None` if it was not there.
    ///
    /// # Errors
    /// [`JournalError::Io`] or [`JournalError::Wire`] if the record cannot be read again.
    pub fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        self.results.recall(job)
    }

    /// How many jobs had a result.
    pub const fn len(&self) -> usize {
        self.results.len()
    }

    /// Whether no job had one.
    pub const fn is_empty(&self) -> bool {
        self.results.len() == 0
    }

    /// What reading it was like.
    pub const fn report(&self) -> &ReadReport {
        &self.report
    }
}

/// Reads the numbers of jobs and the hashes of their contents from a journal; each is given as often as the job was
/// asked for or answered.
///
/// # Errors
/// As [`fold`].
pub fn numbers(path: &Path, mut given: impl FnMut(JobId, ContentHash)) -> Result<(), JournalError> {
    let report = fold(path, |_, event| match event {
        Event::Asked { job, work } => given(job, work),
        // of a job whose question was lost to damage the answer is left
        Event::Finished(finished) => given(finished.job(), finished.work),
        Event::Begun { .. }
        | Event::Opened { .. }
        | Event::Joined { .. }
        | Event::Left { .. }
        | Event::Closed
        | Event::Proved { .. }
        | Event::Accounted(_) => {}
    });
    report.map(drop)
}
