//! Results of finished studies, read from their journals: nothing is simulated, and no step of a study is repeated.
use super::entry::{DiagnosisResult, Entry, IdentificationStudy};
use discrepancy::record::Record;
use journal::{JournalError, event::Event};
use protocol::{id::JobId, wire};
use std::{collections::BTreeMap, path::Path, time::Duration};

/// Reason why the result of a run cannot be read from its journal.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The study has not reached its end.
    #[error("the run has not been finished")]
    Unfinished,
    /// Results that the study used are missing, because the journal is damaged.
    #[error("results of the run are missing in its journal, which is damaged")]
    Incomplete,
}

/// Diagnosis as its journal states it.
#[derive(Clone, Debug)]
pub struct RecordedDiagnosis {
    /// Result of the diagnosis.
    pub result: DiagnosisResult,
    /// Measured records that were diagnosed, cycle by cycle.
    pub records: Vec<Record>,
    /// Slot time of the simulations of each purpose, by its name; those of a stage have the stage's name.
    pub slot_times: BTreeMap<String, Duration>,
}

/// Reads a finished diagnosis from its journal.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, or the diagnosis has not been finished.
pub fn read_diagnosis(path: &Path) -> Result<RecordedDiagnosis, RecordError> {
    let (mut reasons, mut slot_times) = (BTreeMap::<JobId, String>::new(), BTreeMap::new());
    let entries = read_entries(path, |event| match event {
        Event::Asked(asked) => drop(reasons.insert(asked.job, asked.reason.purpose)),
        Event::Finished(finished) => {
            // the first result of a job counts
            if let Some(purpose) = reasons.remove(&finished.job()) {
                let time: &mut Duration = slot_times.entry(purpose).or_default();
                *time += Duration::from_micros(finished.cost.wall_us);
            }
        }
        Event::Begun { .. }
        | Event::Opened { .. }
        | Event::Joined { .. }
        | Event::Left { .. }
        | Event::Closed
        | Event::Proved { .. }
        | Event::Accounted(_)
        | Event::Found { .. } => {}
    })?;
    let (mut result, mut records) = (None, Vec::new());
    for entry in entries {
        match entry {
            Entry::Records(own) => records = own,
            Entry::Diagnosed(own) => result = Some(*own),
            Entry::Noted(_) | Entry::Calibrated { .. } | Entry::Identified(_) => {}
        }
    }
    Ok(RecordedDiagnosis {
        result: result.ok_or(RecordError::Unfinished)?,
        records,
        slot_times,
    })
}

/// Reads the result of a finished identification from its journal.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, or the identification has not been finished.
pub fn read_identification(path: &Path) -> Result<IdentificationStudy, RecordError> {
    let found = read_entries(path, |_| ())?
        .into_iter()
        .find_map(|entry| match entry {
            Entry::Identified(own) => Some(*own),
            Entry::Records(_)
            | Entry::Noted(_)
            | Entry::Calibrated { .. }
            | Entry::Diagnosed(_) => None,
        });
    found.ok_or(RecordError::Unfinished)
}

/// Reads the entries of a study in their order, and calls `apply` with every event of the journal.
///
/// # Errors
/// [`RecordError::Journal`] if the journal cannot be read.
pub(super) fn read_entries(
    path: &Path,
    mut apply: impl FnMut(Event),
) -> Result<Vec<Entry>, RecordError> {
    let (mut entries, mut unreadable) = (BTreeMap::new(), None);
    journal::fold(path, |at, event| {
        if let Event::Found { number, entry } = &event {
            match wire::decode::<Entry>(entry) {
                Ok(entry) => drop(entries.entry(*number).or_insert(entry)),
                Err(_) => unreadable = unreadable.or(Some(at.at)),
            }
        }
        apply(event);
    })?;
    if let Some(at) = unreadable {
        let path = path.to_owned();
        return Err(JournalError::Undecodable { path, at }.into());
    }
    Ok(entries.into_values().collect())
}
