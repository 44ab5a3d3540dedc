//! Reading of a case's working conditions: their numbers, load cards and gauge records.
use super::{
    card,
    record::{self, Expected, RecordFacts},
    schema::{CaseFile, ConditionEntry},
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, Faults, damaged},
    names,
    note::Note,
    source::RecordFolder,
};
use ::record::Record;
use protocol::{
    case::{Channel, Condition},
    pumping_unit::{Smoothing, WorkingCondition},
};
use std::path::{Path, PathBuf};

/// Difference of two speeds, relative, with which a load card counts as taken at both: the slip of a belt.
const SAME_SPEED: f64 = 0.03;

/// Inputs from which the working conditions of a pumping-unit case are read.
#[derive(Debug, Clone, Copy)]
struct Conditions<'a> {
    /// Folder of the case, and the folder whose cards and records of the same names replace those of the
    /// case.
    source: RecordFolder<'a>,
    file: &'a CaseFile,
}

/// Working condition of a pumping unit as read from its files, with its gauge record and notes.
#[derive(Debug)]
pub(super) struct ReadCondition {
    pub(super) condition: Condition,
    pub(super) working: WorkingCondition,
    pub(super) channels: Vec<Channel>,
    pub(super) facts: Option<RecordFacts>,
    pub(super) cycles: Option<Record>,
    pub(super) notes: Vec<Note>,
}

/// Reads every condition, in the order of the file.
///
/// # Errors
/// Returns an error for duplicate or invalid names, and all faults of the conditions.
pub(super) fn read_all(
    source: &RecordFolder<'_>,
    file: &CaseFile,
) -> Result<Vec<ReadCondition>, CaseError> {
    let list = file.conditions.iter();
    let list: Vec<&str> = list.map(|entry| entry.name.as_str()).collect();
    names::check(source.document, "conditions", "condition", &list)?;
    let all = Conditions {
        source: *source,
        file,
    };
    let mut faults = Faults::default();
    let indices = 0..file.conditions.len();
    let read = indices.filter_map(|index| faults.take(all.condition(index)));
    let mut read: Vec<ReadCondition> = read.collect();
    faults.end()?;
    for (index, condition) in read.iter_mut().enumerate() {
        condition.notes.extend(all.borrowed_card(index));
    }
    Ok(read)
}

impl Conditions<'_> {
    /// Reads a working condition with its load card and gauge record.
    fn condition(&self, index: usize) -> Result<ReadCondition, CaseError> {
        let Some(entry) = self.file.conditions.get(index) else {
            return Err(damaged(
                &self.source.document.path,
                "no such condition",
                "add it",
            ));
        };
        let keys = |key| {
            [
                DocumentStep::Key("conditions"),
                DocumentStep::Index(index),
                DocumentStep::Key(key),
            ]
        };
        check_condition(self.source.document, entry, keys)?;
        let role = format!(
            "the load card of condition `{}` in {}",
            entry.name,
            self.source.document.path.display()
        );
        let not_repeated = self.not_repeated(entry);
        let card_file = if not_repeated.is_some() && !self.place(&entry.card_file).exists() {
            self.source.folder.join(&entry.card_file)
        } else {
            self.place(&entry.card_file)
        };
        let record_file = entry.record_file.as_ref();
        let record_file = record_file.filter(|_| not_repeated.is_none());
        let record_file = record_file.map(|name| self.place(name));
        let mut faults = Faults::default();
        let card = faults.take(card::read(&card_file, entry.smoothing, &role));
        if let (None, Some(file)) = (&card, &record_file) {
            faults.take(record::read(file, &self.expected(index, entry)));
        }
        faults.end()?;
        let Some(card) = card else {
            return Err(damaged(&card_file, "it cannot be read", "copy it again"));
        };
        let highest = card.load_n.len() / 2;
        if let Smoothing::Harmonics(kept) = entry.smoothing
            && kept as usize > highest
        {
            return Err(self.source.document.field(
                &keys("smoothing"),
                format!("{{ harmonics = {kept} }}"),
                format!(
                    "1 to {highest}: a card of {} points has no more",
                    card.load_n.len()
                ),
                "keep fewer harmonics, or use smoothing = \"none\"",
            ));
        }
        let read = record_file.map(|file| record::read(&file, &self.expected(index, entry)));
        let read = read.transpose()?;
        let condition = Condition {
            name: entry.name.clone(),
        };
        let working = WorkingCondition {
            speed_rpm: entry.speed_rpm,
            counterweight_moment_n_m: entry.counterweight_moment_n_m,
            card,
        };
        Ok(match read {
            Some(read) => ReadCondition {
                condition,
                working,
                channels: read.channels,
                facts: Some(read.facts),
                cycles: Some(read.cycles),
                notes: read.notes,
            },
            None => ReadCondition {
                condition,
                working,
                channels: record::channels(index, self.file.run.output_step_deg),
                facts: None,
                cycles: None,
                notes: not_repeated.into_iter().collect(),
            },
        })
    }

    /// Returns a note if a condition has the load card of an earlier one with another speed.
    fn borrowed_card(&self, index: usize) -> Option<Note> {
        let entry = self.file.conditions.get(index)?;
        let lender = self.file.conditions.iter().take(index).find(|other| {
            let apart = (other.speed_rpm / entry.speed_rpm - 1.0).abs() > SAME_SPEED;
            other.card_file == entry.card_file && apart
        })?;
        Some(Note {
            path: self.source.document.path.clone(),
            text: format!(
                "condition `{}` ({} /min) has the load card of `{}` ({} /min): the load of a pump changes with its \
                 speed, so that this is no prediction for `{0}`; measure its card, or compute it with a program for \
                 rod strings",
                entry.name, entry.speed_rpm, lender.name, lender.speed_rpm
            ),
        })
    }

    /// Returns the values with which the record of a condition must agree.
    fn expected<'b>(&'b self, index: usize, entry: &'b ConditionEntry) -> Expected<'b> {
        Expected {
            index,
            condition: &entry.name,
            speed_rpm: entry.speed_rpm,
            case_file: &self.source.document.path,
            step_deg: self.file.run.output_step_deg,
            sense: self.file.crank.sense,
        }
    }

    /// Returns a note if the folder of `--measured DIR` lacks the record of a condition; the condition then
    /// has no record and keeps the case's card. The records of the objective's conditions are required.
    fn not_repeated(&self, entry: &ConditionEntry) -> Option<Note> {
        let measured = self.source.measured?;
        let record = self.place(entry.record_file.as_ref()?);
        let objective = self.file.objective.as_ref();
        let needed = objective.is_some_and(|objective| objective.condition.names(&entry.name));
        (!needed && !record.exists()).then(|| Note {
            path: measured.to_owned(),
            text: format!(
                "{} does not exist: condition `{}` has no record and is not compared",
                record.file_name().unwrap_or_default().display(),
                entry.name
            ),
        })
    }

    /// Returns the path of a load card or gauge record: in the folder of `--measured DIR` under the same name
    /// if given, otherwise in the case's folder.
    fn place(&self, named: &Path) -> PathBuf {
        match (self.source.measured, named.file_name()) {
            (Some(measured), Some(name)) => measured.join(name),
            _ => self.source.folder.join(named),
        }
    }
}

/// Checks the ranges of a condition's speed and counterweight moment.
fn check_condition<'a>(
    document: &Document,
    entry: &ConditionEntry,
    keys: impl Fn(&'static str) -> [DocumentStep<'a>; 3],
) -> Result<(), CaseError> {
    if !(0.1..=60.0).contains(&entry.speed_rpm) {
        return Err(document.field(
            &keys("speed_rpm"),
            entry.speed_rpm,
            "0.1 to 60 revolutions per minute",
            "give the crank speed, not the motor's",
        ));
    }
    if !(0.0..=1.0e7).contains(&entry.counterweight_moment_n_m) {
        return Err(document.field(
            &keys("counterweight_moment_n_m"),
            entry.counterweight_moment_n_m,
            "0 to 1e7 N m",
            "give weight times radius of the counterweights in N m",
        ));
    }
    Ok(())
}
