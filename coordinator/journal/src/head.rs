//! Copy of a journal's first record, in a separate file.
//!
//! A damaged block may cover every record of a short journal; the copy then still identifies the run and its
//! settings. The file has the format of a journal with one record.
use super::{
    error::JournalError,
    read::fold,
    record::{HEAD, record},
};
use crate::event::{Event, RunHeader};
use protocol::id::RunId;
use std::path::Path;
use support::atomic_file;

/// Reads the copy of the journal's first record (run identifier and settings) in a run folder; `None` if
/// there is no readable copy.
pub(super) fn read(folder: &Path) -> Result<Option<(RunId, RunHeader)>, JournalError> {
    let path = folder.join(HEAD);
    if !path.exists() {
        return Ok(None);
    }
    let mut found = None;
    let read = fold(&path, |_, event| {
        if let Event::Begun { run, header } = event {
            found = Some((run, header));
        }
    });
    match read {
        // the journal itself has been asked for its version and can be read
        Ok(_) | Err(JournalError::Version { .. } | JournalError::Undecodable { .. }) => Ok(found),
        Err(error) => Err(error),
    }
}

/// Writes the copy of the journal's first record into a run folder as an atomic replacement of the file.
pub(super) fn write(folder: &Path, run: RunId, header: &RunHeader) -> Result<(), JournalError> {
    let header = header.clone();
    let bytes = record(&Event::Begun { run, header })?;
    let path = folder.join(HEAD);
    let written = atomic_file::replace(&path, &bytes);
    written.map_err(|source| JournalError::Io {
        doing: "write",
        path,
        source,
    })
}
