//! The copy of a journal's first record, in a file of its own.
//!
//! A damaged block may cover every record of a short journal; the copy then still says what the
//! run is and what it is called. It is a record like any other, in a journal of one record.
use super::{
    error::JournalError,
    read::fold,
    record::{HEAD, record},
};
use protocol::{
    event::{Event, RunHeader},
    id::RunId,
};
use std::path::Path;
use support::atomic_file;

/// The copy of a run folder; none if there is none that can be read.
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
        // the journal itself has been asked for its version
        Ok(_) | Err(JournalError::Version { .. }) => Ok(found),
        Err(error) => Err(error),
    }
}

/// Puts a copy into a run folder, whole or not at all.
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
