//! Results of finished studies, read from their journals: nothing is simulated, and no step of a study is repeated.
use super::entry::{DiagnosisResult, Entry, IdentificationStudy};
use super::evaluate::{Scored, scored};
use super::orthogonal::{TestResult, TrialRun};
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
            Entry::Noted(_)
            | Entry::Calibrated { .. }
            | Entry::Identified(_)
            | Entry::Swept(_)
            | Entry::Tested(_)
            | Entry::Table { .. } => {}
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
    read_entry(path, |entry| {
        let Entry::Identified(own) = entry else {
            return None;
        };
        Some(*own)
    })
}

/// Reads the results of the searches of a finished grid from its journal.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, or the sweep has not been finished.
pub fn read_grid(path: &Path) -> Result<Vec<TrialRun>, RecordError> {
    read_entry(path, |entry| {
        let Entry::Swept(own) = entry else {
            return None;
        };
        Some(own)
    })
}

/// Reads the result of a finished orthogonal test from its journal.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, or the test has not been finished.
pub fn read_test(path: &Path) -> Result<TestResult, RecordError> {
    read_entry(path, |entry| {
        let Entry::Tested(own) = entry else {
            return None;
        };
        Some(*own)
    })
}

/// Table of individuals with the result of each.
#[derive(Clone, Debug)]
pub struct RecordedTable {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Values of the searched unknowns of each individual, in declared units.
    pub rows: Vec<Vec<f64>>,
    /// Result of each individual.
    pub scores: Vec<Scored>,
}

/// Reads a finished table of individuals from its journal; `expand` returns the values of all unknowns of the case
/// for those of a row.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, the table has not been finished, or results are missing.
pub fn read_table(
    path: &Path,
    expand: impl Fn(&[f64]) -> Vec<f64>,
) -> Result<RecordedTable, RecordError> {
    let bits = |genes: &[f64]| -> Vec<u64> { genes.iter().map(|gene| gene.to_bits()).collect() };
    let (mut asked, mut found) = (BTreeMap::new(), BTreeMap::new());
    let entries = read_entries(path, |event| match event {
        Event::Asked(own) => {
            let individual = own.individual.map(|individual| bits(&individual.genes));
            asked.insert(own.job, individual.unwrap_or_default());
        }
        Event::Finished(finished) => {
            let id = finished.job();
            if let Some(genes) = asked.remove(&id)
                && let Ok(scored) = scored(id, finished.outcome)
            {
                found.entry(genes).or_insert(scored);
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
    let table = entries.into_iter().find_map(|entry| {
        let Entry::Table { names, rows } = entry else {
            return None;
        };
        Some((names, rows))
    });
    let (names, rows) = table.ok_or(RecordError::Unfinished)?;
    let scores = rows
        .iter()
        .map(|row| found.get(&bits(&expand(row))).cloned());
    let scores: Option<Vec<Scored>> = scores.collect();
    Ok(RecordedTable {
        names,
        scores: scores.ok_or(RecordError::Incomplete)?,
        rows,
    })
}

/// Reads the first entry that `take` accepts.
fn read_entry<T>(path: &Path, take: impl FnMut(Entry) -> Option<T>) -> Result<T, RecordError> {
    let entries = read_entries(path, |_| ())?;
    entries
        .into_iter()
        .find_map(take)
        .ok_or(RecordError::Unfinished)
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
