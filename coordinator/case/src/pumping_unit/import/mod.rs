//! Import of records and load cards from the files of data loggers and dynamometers.
//!
//! A mapping file beside the record states which columns of which raw files are what, in which unit. It is
//! proposed from the content of the files; the import reads nothing but the mapping and the raw files, so that
//! repeating it gives the same record. Raw files are never written.
mod card;
mod card_proposal;
mod cleaning;
mod logger;
mod mapping;
mod paths;
mod proposal;
mod record;
mod role;
mod sheet;
mod turns;

pub use card::ImportedCard;
pub use proposal::MappingProposal;

use super::{
    SHEET_TEMPLATE, geometry,
    record::{Expected, GaugeRecord, Samples, grid, of, sheet_path, whole},
    schema::{CaseFile, ConditionEntry},
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, contradiction, damaged},
    file,
    note::Note,
    source::{self, Overrides, stated_kind},
};
use ::record::Record;
use protocol::{
    case::Channel,
    pumping_unit::{Machine, Sensor},
};
use std::path::{Path, PathBuf};

/// Difference between the stated zero of the angle and that by the rod position that is worth a remark \[deg\]:
/// the shipped record has 0.2.
const ZERO_NOTED: f64 = 3.0;

/// Condition of a case to which raw files are imported.
#[derive(Debug)]
pub struct ImportTarget {
    document: Document,
    case: CaseFile,
    /// Index of the condition.
    index: usize,
    folder: PathBuf,
    /// Command that repeats an import.
    command: String,
}

/// Kind of what is imported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImportKind {
    /// Gauge record.
    Record,
    /// Load card.
    Card,
}

/// Gauge record that was imported, before it is written.
#[derive(Debug)]
pub struct ImportedRecord {
    /// Path and content of each file to write: the record and its data sheet.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// Number of samples.
    pub samples: usize,
    /// Number of whole turns.
    pub turns: usize,
    /// Mean speed of the crank [1/min].
    pub speed_rpm: f64,
    /// Sampling rate \[Hz\].
    pub rate_hz: f64,
    /// Crank angles of the curves \[deg\].
    pub turn_deg: Vec<f64>,
    /// Channel of each recorded curve.
    pub channels: Vec<Channel>,
    /// Curves of each whole turn, in the order of the channels.
    pub cycles: Vec<Vec<Vec<f64>>>,
    /// Remarks for the user.
    pub notes: Vec<String>,
}

impl ImportTarget {
    /// Reads the case file and finds the condition; a case with one condition needs no name.
    ///
    /// # Errors
    /// Returns an error for a malformed case file, a case of another kind, and an unknown condition.
    pub fn new(folder: &Path, condition: Option<&str>) -> Result<Self, CaseError> {
        let document = source::document(folder, &Overrides::default())?;
        let stated = stated_kind(&document)?;
        if stated != Machine::KIND {
            return Err(document.field(
                &[DocumentStep::Key("model"), DocumentStep::Key("kind")],
                format!("\"{stated}\""),
                format!(
                    "\"{}\": raw files are imported for pumping units",
                    Machine::KIND
                ),
                "write the records of other models as tables, see docs/case-file.md",
            ));
        }
        let case: CaseFile = document.parse()?;
        let names: Vec<&str> = case
            .conditions
            .iter()
            .map(|own| own.name.as_str())
            .collect();
        let found = match condition {
            None if names.len() == 1 => Some(0),
            None => None,
            Some(name) => names.iter().position(|own| *own == name),
        };
        let Some(index) = found else {
            let problem = condition.map_or_else(
                || "the case has several conditions".to_owned(),
                |name| format!("the case has no condition `{name}`"),
            );
            return Err(damaged(
                &document.path,
                problem,
                &format!(
                    "name the condition that was recorded: --condition {}",
                    names.join(" or ")
                ),
            ));
        };
        let name = &names[index];
        let quoted =
            |text: &str| shlex::try_quote(text).map_or_else(|_| text.to_owned(), Into::into);
        let command = format!(
            "horsehead record import --case {} --condition {}",
            quoted(&folder.display().to_string()),
            quoted(name)
        )
        .replace(char::is_control, " ");
        Ok(Self {
            index,
            folder: folder.to_owned(),
            command,
            document,
            case,
        })
    }

    fn condition(&self) -> &ConditionEntry {
        &self.case.conditions[self.index]
    }

    /// Returns the name of the condition.
    pub fn name(&self) -> &str {
        &self.condition().name
    }

    /// Returns the path of the record or card that the case names.
    ///
    /// # Errors
    /// Returns an error for a condition without `record_file`.
    pub fn output(&self, kind: ImportKind) -> Result<PathBuf, CaseError> {
        let condition = self.condition();
        match (kind, &condition.record_file) {
            (ImportKind::Card, _) => Ok(self.folder.join(&condition.card_file)),
            (ImportKind::Record, Some(file)) => Ok(self.folder.join(file)),
            (ImportKind::Record, None) => Err(self.document.field(
                &[
                    DocumentStep::Key("conditions"),
                    DocumentStep::Index(self.index),
                    DocumentStep::Key("name"),
                ],
                format!("\"{}\"", condition.name),
                "a condition with `record_file`, the file to which the record is written",
                &format!(
                    "add record_file = \"measured/test_{}.csv.gz\"",
                    condition.name
                ),
            )),
        }
    }

    /// Returns the path of the mapping file of the record or card.
    ///
    /// # Errors
    /// As [`Self::output`].
    pub fn mapping(&self, kind: ImportKind) -> Result<PathBuf, CaseError> {
        Ok(sheet_path(&self.output(kind)?).with_extension("import.toml"))
    }

    /// Proposes the mapping of raw files, for the mapping file.
    ///
    /// # Errors
    /// Returns an error for a file that cannot be read or has no table, and for a record or card that exists
    /// and was not imported: it is not replaced.
    pub fn propose(
        &self,
        kind: ImportKind,
        files: &[PathBuf],
    ) -> Result<MappingProposal, CaseError> {
        let output = self.output(kind)?;
        if output.exists() {
            return Err(damaged(
                &output,
                "it exists, and no mapping beside it says from what: it would be lost",
                "move it away, or name another file in the case; it is unchanged",
            ));
        }
        let Some(first) = files.first() else {
            return Err(damaged(
                &self.mapping(kind)?,
                "there is no mapping to repeat",
                "name the raw files to import",
            ));
        };
        if let (ImportKind::Card, Some(second)) = (kind, files.get(1)) {
            return Err(damaged(
                second,
                "it is a second card for the condition",
                "import one card for each condition",
            ));
        }
        let beside = output.parent().unwrap_or_else(|| Path::new("."));
        let names: Vec<String> = files
            .iter()
            .map(|file| paths::relative(file, beside).display().to_string())
            .collect();
        let known = proposal::Known {
            young_gpa: self.case.flexible_head.young_gpa,
            rod_position_m: self.rod_position()?,
            command: self.command.clone(),
        };
        match kind {
            ImportKind::Record => proposal::propose(first, &names, &known),
            ImportKind::Card => card_proposal::propose(first, &names[0], &known),
        }
    }

    /// Checks that a mapping file is of the given raw files; without any it is repeated as it is.
    ///
    /// # Errors
    /// Returns an error that names both.
    pub fn check_files(&self, kind: ImportKind, files: &[PathBuf]) -> Result<(), CaseError> {
        let path = self.mapping(kind)?;
        let document = Document::read(&path, "the mapping of an import")?;
        let table: toml::Table = document.parse()?;
        let folder = path.parent().unwrap_or_else(|| Path::new("."));
        let stated = table.get("files").and_then(toml::Value::as_array);
        let stated = stated.into_iter().flatten().filter_map(toml::Value::as_str);
        let real = |path: PathBuf| path.canonicalize().unwrap_or(path);
        let stated: Vec<PathBuf> = stated.map(|file| real(folder.join(file))).collect();
        let output = self.output(kind)?;
        let results = [output.clone(), sheet_path(&output)].map(real);
        if let Some(raw) = stated.iter().find(|raw| results.contains(raw)) {
            return Err(damaged(
                raw,
                "it is a raw file and the file to write at once",
                "name another record_file or card_file in the case: raw files are never changed",
            ));
        }
        let given: Vec<PathBuf> = files.iter().cloned().map(real).collect();
        if given.is_empty() || given == stated {
            return Ok(());
        }
        let list = |files: &[PathBuf]| {
            let names = files.iter().map(|file| file.display().to_string());
            names.collect::<Vec<_>>().join(", ")
        };
        Err(contradiction(
            &path,
            "`files`",
            list(&stated),
            format!("the command names {}", list(&given)),
            "correct `files` to import others by the same mapping; for a new proposal move mapping and record \
             away",
        ))
    }

    /// Imports the record by its mapping file, and reads it back as the case will.
    ///
    /// # Errors
    /// Returns the first fault of mapping, raw files or record; nothing is written.
    pub fn import_record(&self) -> Result<ImportedRecord, CaseError> {
        let mapping = Document::read(
            &self.mapping(ImportKind::Record)?,
            "the mapping of the record",
        )?;
        let condition = self.condition();
        let expected = Expected {
            index: self.index,
            condition: &condition.name,
            speed_rpm: condition.speed_rpm,
            case_file: &self.document.path,
            step_deg: self.case.run.output_step_deg,
            sense: self.case.crank.sense,
        };
        let read = record::import(
            &mapping,
            record::Condition {
                speed_rpm: expected.speed_rpm,
                step_deg: expected.step_deg,
            },
        )?;
        let output = self.output(ImportKind::Record)?;
        let samples = Samples::read(&output, read.csv.as_bytes())?;
        let sheet = filled_sheet(&output, &samples, &read)?;
        let GaugeRecord {
            channels,
            cycles,
            notes,
            ..
        } = of(&output, read.csv.as_bytes(), &sheet, &expected)?;
        let mut all = read.notes;
        all.extend(self.zero_note(&cycles)?);
        all.extend(notes.iter().map(|note: &Note| note.text.clone()));
        let packed = file::packed(&output, read.csv.as_bytes())?;
        let recorded = cycles.channels.iter();
        let recorded = recorded.filter_map(|own| channels.get(own.curve).cloned());
        Ok(ImportedRecord {
            channels: recorded.collect(),
            files: vec![
                (sheet_path(&output), sheet.text().as_bytes().to_vec()),
                (output, packed),
            ],
            samples: samples.angle_deg.len(),
            turns: cycles.cycles.len(),
            speed_rpm: read.speed_rpm,
            rate_hz: 1.0 / samples.step_s,
            turn_deg: grid(expected.step_deg),
            cycles: cycles.cycles,
            notes: all,
        })
    }

    /// Imports the load card by its mapping file, and reads it back as the case will.
    ///
    /// # Errors
    /// Returns the first fault of mapping, raw file or card; nothing is written.
    pub fn import_card(&self) -> Result<ImportedCard, CaseError> {
        let mapping = Document::read(&self.mapping(ImportKind::Card)?, "the mapping of the card")?;
        let machine = card::Machine {
            speed_rpm: self.condition().speed_rpm,
            position_m: self.rod_position()?,
        };
        let imported = card::import(&mapping, &machine)?;
        super::card::of(&self.output(ImportKind::Card)?, imported.csv.as_bytes())?;
        Ok(imported)
    }

    /// Returns a note if the recorded rod position is lowest far from the stated bottom dead centre.
    fn zero_note(&self, cycles: &Record) -> Result<Option<String>, CaseError> {
        let turn = grid(self.case.run.output_step_deg);
        let curve = Sensor::ALL
            .iter()
            .position(|sensor| *sensor == Sensor::Position);
        let place = cycles
            .channels
            .iter()
            .position(|own| Some(own.curve) == curve);
        let Some(position) = place.and_then(|at| cycles.cycles.first()?.get(at)) else {
            return Ok(None);
        };
        let found = proposal::lowest_deg(&turn, position, &self.rod_position()?);
        let off = found.map(|angle| (angle + 180.0).rem_euclid(360.0) - 180.0);
        Ok(off.filter(|off| off.abs() > ZERO_NOTED).map(|off| {
            format!(
                "by the rod position bottom dead centre is {off:+.1} deg from where the mapping states it: check \
                 `angle`, and the sign of the position"
            )
        }))
    }

    fn rod_position(&self) -> Result<Vec<f64>, CaseError> {
        geometry::rod_position(&self.case).ok_or_else(|| {
            damaged(
                &self.document.path,
                "the crank cannot complete a turn with these lengths",
                "`horsehead case check` says which number is wrong",
            )
        })
    }
}

/// Returns the data sheet with what the import measured: the present one, or the template.
fn filled_sheet(
    output: &Path,
    samples: &Samples,
    read: &record::ConvertedRecord,
) -> Result<Document, CaseError> {
    let path = sheet_path(output);
    let present = if path.exists() {
        Document::read(&path, "the data sheet of the record")?
    } else {
        Document::new(path.clone(), SHEET_TEMPLATE.to_owned())
    };
    let digits = |value: f64, places: i32| {
        let scale = libm::pow(10.0, f64::from(places));
        (value * scale).round() / scale
    };
    let count = |value: u64| i64::try_from(value).unwrap_or(i64::MAX);
    let rows = samples.angle_deg.len() as u64;
    let span = samples.angle_deg.last().unwrap_or(&0.0) - samples.angle_deg.first().unwrap_or(&0.0);
    let mut values = vec![
        ("", "strokes_per_minute", digits(read.speed_rpm, 3).into()),
        ("", "sample_rate_hz", digits(1.0 / samples.step_s, 2).into()),
        (
            "",
            "revolutions",
            count(whole((span / 360.0).round())).into(),
        ),
        ("", "samples_recorded", count(rows).into()),
        ("", "samples_lost", count(samples.lost).into()),
        ("gauges", "unit", "MPa".into()),
        ("tolerance", "index_deg", read.uncertainty_deg.into()),
    ];
    if let Some(resolution) = read.resolution_mpa {
        values.push(("gauges", "resolution_mpa", digits(resolution, 6).into()));
    }
    Ok(Document::new(path, sheet::fill(&present, &values)?))
}

/// Returns whether a file is a record or a load card.
///
/// # Errors
/// Returns an error for a file that cannot be read, or has no table.
pub fn kind_of(path: &Path) -> Result<ImportKind, CaseError> {
    Ok(if card_proposal::is_card(path)? {
        ImportKind::Card
    } else {
        ImportKind::Record
    })
}
