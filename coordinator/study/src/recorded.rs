//! Results of finished studies, read from their journals: nothing is simulated, and no step of a study is repeated.
use super::entry::{DiagnosisResult, Entry, IdentificationStudy};
use super::evaluate::{Scored, scored};
use super::orthogonal::{TestResult, TrialRun};
use journal::{Answers, Damage, JournalError, event::Event};
use protocol::wire;
use record::Record;
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
    /// Stretches of the journal that cannot be read.
    pub damage: Vec<Damage>,
}

/// Reads a finished diagnosis from its journal.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, or the diagnosis has not been finished.
pub fn read_diagnosis(path: &Path) -> Result<RecordedDiagnosis, RecordError> {
    let (mut answers, mut slot_times) = (Answers::default(), BTreeMap::new());
    let (entries, damage) = read_entries(path, |event| {
        if let Some((asked, finished)) = answers.pair(event) {
            let time: &mut Duration = slot_times.entry(asked.reason.purpose).or_default();
            *time += Duration::from_micros(finished.cost.wall_us);
        }
    })?;
    let (mut result, mut records) = (None, Vec::<Record>::new());
    for entry in entries {
        match entry {
            Entry::Record(own) => match records.last_mut() {
                Some(last) if last.condition == own.condition => last.cycles.extend(own.cycles),
                Some(_) | None => records.push(own),
            },
            Entry::Diagnosed(own) => result = Some(*own),
            Entry::Noted(_)
            | Entry::Planned { .. }
            | Entry::Budgeted(_)
            | Entry::Interim(_)
            | Entry::Calibrated { .. }
            | Entry::Estimated(_)
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
        damage,
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
    let (mut answers, mut found) = (Answers::default(), BTreeMap::new());
    let (entries, _) = read_entries(path, |event| {
        if let Some((asked, finished)) = answers.pair(event)
            && let Some(individual) = asked.individual
            && let Ok(scored) = scored(asked.job, finished.outcome)
        {
            found.insert(bits(&individual.genes), scored);
        }
    })?;
    let mut table = (Vec::new(), Vec::new(), None);
    for entry in entries {
        if let Entry::Table { names, rows, total } = entry {
            table.0 = names;
            table.1.extend(rows);
            table.2 = Some(total);
        }
    }
    let (names, rows, total) = table;
    if total != Some(rows.len() as u64) {
        return Err(RecordError::Unfinished);
    }
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
    let (entries, _) = read_entries(path, |_| ())?;
    entries
        .into_iter()
        .find_map(take)
        .ok_or(RecordError::Unfinished)
}

/// Reads the entries of a study in their order, and the stretches of the journal that cannot be read; calls `apply` with
/// every event.
///
/// # Errors
/// [`RecordError::Journal`] if the journal cannot be read, [`RecordError::Incomplete`] if an entry is missing before
/// the last one.
pub(super) fn read_entries(
    path: &Path,
    mut apply: impl FnMut(Event),
) -> Result<(Vec<Entry>, Vec<Damage>), RecordError> {
    let (mut entries, mut unreadable) = (BTreeMap::<u64, Entry>::new(), None);
    let report = journal::fold(path, |at, event| {
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
    if entries
        .keys()
        .zip(0..)
        .any(|(number, expected)| *number != expected)
    {
        return Err(RecordError::Incomplete);
    }
    Ok((entries.into_values().collect(), report.damage))
}
