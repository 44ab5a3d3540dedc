//! Numbers of the jobs in a journal.
use super::{error::JournalError, read::fold};
use crate::event::Event;
use protocol::id::{ContentHash, JobId};
use std::path::Path;

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
