//! Entries of a study: what it finds and concludes, numbered in the order in which it finds them.
use super::error::JournalError;
use crate::event::Event;
use protocol::wire;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Entries of the study in one coordinator process, compared with those that earlier processes of the run recorded.
#[derive(Clone, Debug)]
pub struct StudyEntries {
    path: PathBuf,
    recorded: BTreeMap<u64, Vec<u8>>,
    next: u64,
}

impl StudyEntries {
    /// Creates the entries of a process of the run of a journal, which holds the `recorded` ones.
    pub(super) fn new(path: &Path, recorded: BTreeMap<u64, Vec<u8>>) -> Self {
        Self {
            path: path.to_owned(),
            recorded,
            next: 0,
        }
    }

    /// Returns the event to write for the study's next entry; `None` if an earlier process recorded the same.
    ///
    /// # Errors
    /// [`JournalError::EntryDiffers`] if an earlier process recorded another entry under the same number,
    /// [`JournalError::Wire`] if the entry is too long for a record.
    pub fn enter(&mut self, entry: Vec<u8>) -> Result<Option<Event>, JournalError> {
        // with its number and length, which are encoded, too
        let bytes = entry.len() + 64;
        if bytes > wire::BODY_LIMIT {
            let limit = wire::BODY_LIMIT;
            return Err(wire::WireError::TooLong { bytes, limit }.into());
        }
        let number = self.next;
        self.next += 1;
        match self.recorded.get(&number) {
            Some(recorded) if *recorded == entry => Ok(None),
            Some(_) => Err(JournalError::EntryDiffers {
                path: self.path.clone(),
                number,
            }),
            None => Ok(Some(Event::Found {
                number,
                entry: entry.into(),
            })),
        }
    }
}
