//! Manifest of a run: the inputs that determine its result, and the command that resumes it.
use crate::{
    command_line::{command_line, quote, quote_path},
    hash,
};
use case::{CaseEffect, GeneFile, Loaded, Note};
use protocol::case::Case;
use search::{
    space::{Space, SpaceError},
    strategy::{CATALOGUE, Preset, Settings},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::path::{Path, PathBuf};

/// Name and version of this program, as recorded in runs and exports.
pub const PROGRAM: &str = concat!("horsehead ", env!("CARGO_PKG_VERSION"));

/// Format version of the manifest and case files in a run folder.
pub const FORMAT: u32 = 1;

/// Maximum number of differing settings that are listed by name when two runs differ.
const MAX_LISTED_DIFFERENCES: usize = 3;

/// Preset of `horsehead calibrate` where none is named.
pub const DEFAULT_PRESET: &str = "quick";

/// Kind of run in the manifest of a calibration; assumed for manifests without a kind.
pub const CALIBRATE: &str = "calibrate";
/// Kind of run in the manifest of a diagnosis.
pub const DIAGNOSE: &str = "diagnose";
/// Kind of run in the manifest of an identifiability analysis (`horsehead identify`).
pub const IDENTIFY: &str = "identify";
/// Kind of run in the manifest of `horsehead evaluate`, which scores individuals for another program.
pub const EVALUATE: &str = "evaluate";
/// Kind of run in the manifest of an assessment of the life of a part.
pub const LIFE: &str = "life";
/// Kind of run in the manifest of an assessment of the balance of a drive.
pub const BALANCE: &str = "balance";

/// Returns `calibrate`, the kind of run assumed for a manifest that names none.
pub(crate) fn calibrate() -> String {
    CALIBRATE.to_owned()
}

/// Settings of one kind of run that determine its result, in addition to case, seed and start.
pub trait RunIdentity: Serialize + DeserializeOwned + PartialEq + Clone {
    /// Command that creates runs of this kind, as in `horsehead calibrate`.
    const KIND: &'static str;
    /// Whether the command that creates runs of this kind takes a seed.
    const SEEDED: bool = true;

    /// Returns the command that creates runs of this kind, with its positional arguments, quoted for a shell;
    /// `subject` is the folder of the case, or of the run that is assessed.
    fn command(&self, subject: &str) -> String {
        [Self::KIND, " ", subject].concat()
    }

    /// Returns the further command line options that resuming the run requires besides preset, settings and
    /// seed, each word preceded by a space.
    fn arguments(&self) -> String {
        String::new()
    }

    /// Describes how these settings differ from those of an earlier run, for messages.
    fn difference(&self, _earlier: &Self) -> String {
        "its settings differ".to_owned()
    }
}

impl RunIdentity for Settings {
    const KIND: &'static str = CALIBRATE;

    fn difference(&self, earlier: &Self) -> String {
        let same = |preset: &&Preset| preset.strategy == self.strategy();
        let named = CATALOGUE.iter().filter(same).flat_map(Preset::settable);
        let differences = named.filter_map(|one| {
            let (was, is) = (one.value(earlier)?, one.value(self)?);
            (was != is).then(|| format!("{} is {was}, not {is}", one.key))
        });
        let first: Vec<String> = differences.take(MAX_LISTED_DIFFERENCES).collect();
        match first.as_slice() {
            [] => "its search settings differ".to_owned(),
            some => format!("its search settings differ: {}", some.join(", ")),
        }
    }
}

/// Manifest of a run; `S` holds the settings that determine its result in addition to case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest<S = Settings> {
    /// Kind of the run, named after the command that created it.
    #[serde(default = "calibrate")]
    pub kind: String,
    /// Format version of the manifest file.
    pub format: u32,
    /// Name and version of the program that created the run.
    pub program: String,
    /// Command line by which the run was created, quoted for a shell.
    pub command: String,
    /// Name of the search preset that the settings are based on; empty if there is none.
    pub preset: String,
    /// Settings that differ from those of the preset, as `key=value`.
    #[serde(default)]
    pub set: Vec<String>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Settings that determine the result of the run, besides seed and start.
    pub settings: S,
    /// Values of the unknowns from which the search starts; `None` for the recommended values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<StartPoint>,
    /// Table of individuals that the search evaluates first; `None` if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<FirstTable>,
    /// Run that is assessed, where it was when this run was last begun; `None` for a run of a case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assessed: Option<PathBuf>,
    /// Folder from which the case was read.
    pub case_folder: PathBuf,
    /// Folder from which the measured records were read.
    pub measured: String,
    /// Whether the case declares its measured records as synthetic (computed instead of measured).
    #[serde(default)]
    pub synthetic: bool,
    /// Notes about the case and its records.
    pub notes: Vec<String>,
    /// Effects of the case as it states them, with interval and provenance, which the case of the run does not hold.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<CaseEffect>,
    /// Total wall time of the run's finished sessions (s).
    pub wall_s: f64,
}

/// Inputs that determine the result of a run of a given case; serialised for comparison with the journal.
#[derive(Serialize)]
struct Identity<'a, S> {
    seed: u64,
    settings: &'a S,
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    families: Option<&'a [Vec<f64>]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    table: Option<&'a [Vec<f64>]>,
}

/// Individuals that a search evaluates first, stored in the manifest so that the run can be resumed without
/// their file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FirstTable {
    /// File from which the individuals were read.
    pub file: PathBuf,
    /// Values of all unknowns of each individual, in the case's order [declared units].
    pub individuals: Vec<Vec<f64>>,
}

impl FirstTable {
    /// Returns the word that names the individuals in a run's default name.
    ///
    /// # Errors
    /// If the values cannot be encoded.
    pub fn word(&self) -> anyhow::Result<String> {
        Ok(format!("start-{}", hash::short_hash(&self.individuals)?))
    }
}

/// Values of the unknowns at which a run starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartPoint {
    /// Gene file from which the values were read.
    pub file: PathBuf,
    /// Starting value of each unknown, in the case's order [declared units].
    pub genes: Vec<f64>,
    /// Effects of the gene file, which the case of the run has too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<CaseEffect>,
    /// Best fits of other families that the calibration saw whose optimum this is, best first, as `genes`; `None`
    /// where it is not the optimum of a calibration of this case on these records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub families: Option<Vec<Vec<f64>>>,
}

impl StartPoint {
    /// Returns the word that names the start in a run's default name.
    ///
    /// # Errors
    /// If the values cannot be encoded.
    pub fn word(&self) -> anyhow::Result<String> {
        Ok(format!("genes-{}", hash::short_hash(&self.genes)?))
    }

    /// Reads a gene file and gives the case the effects of the file, with a note on each that the file adds, changes or
    /// does not state.
    ///
    /// # Errors
    /// As [`GeneFile::read`] and [`GeneFile::values`].
    pub fn read(file: &Path, loaded: &mut Loaded) -> anyhow::Result<Self> {
        let stated = GeneFile::read(file)?;
        let before = loaded.effects.clone();
        loaded.take_effects(stated.effects());
        let texts = effect_notes(&stated, &before, &loaded.effects);
        loaded.notes.extend(texts.into_iter().map(|text| Note {
            path: file.to_owned(),
            text,
        }));
        Ok(Self {
            file: std::path::absolute(file)?,
            genes: stated.values(&loaded.case)?,
            effects: stated.effects().to_vec(),
            families: None,
        })
    }
}

/// Describes what a gene file changed in the effects of a case, and which of them it does not state.
fn effect_notes(stated: &GeneFile, before: &[CaseEffect], after: &[CaseEffect]) -> Vec<String> {
    let mut notes = Vec::new();
    for effect in after {
        let Some(own) = before.iter().find(|own| own.id == effect.id) else {
            notes.push(format!(
                "its values were found with {}, which the case lacks: added for this run",
                effect.id
            ));
            continue;
        };
        if !stated.states(&effect.id) {
            notes.push(format!(
                "does not state {}, which the case has: the case's own values are used",
                effect.id
            ));
        }
        for (name, parameter) in &effect.parameters {
            let own = own.parameters.get(name).map(|own| own.value);
            if own.is_none_or(|own| own.to_bits() != parameter.value.to_bits()) {
                let own =
                    own.map_or_else(String::new, |own| format!(", in place of the case's {own}"));
                notes.push(format!(
                    "its values were found with {}.{name} = {} {}{own}",
                    effect.id, parameter.value, parameter.unit
                ));
            }
        }
    }
    notes
}

impl<S> Manifest<S> {
    /// Returns the values of the unknowns at which the run starts; `None` for the recommended values.
    pub(crate) fn start_genes(&self) -> Option<&[f64]> {
        self.start.as_ref().map(|start| start.genes.as_slice())
    }

    /// Returns the best fits of other families that the calibration of the start saw; `None` where the start is not
    /// the optimum of a calibration of this case on these records.
    pub(crate) fn families(&self) -> Option<&[Vec<f64>]> {
        self.start.as_ref()?.families.as_deref()
    }

    /// Returns the individuals that the search evaluates first; `None` without a table of them.
    pub(crate) fn first_individuals(&self) -> Option<&[Vec<f64>]> {
        let table = self.table.as_ref();
        table.map(|table| table.individuals.as_slice())
    }

    /// Returns the words that distinguish this run from the default one of its case: preset, settings, and the values
    /// from which it started.
    ///
    /// # Errors
    /// As [`FirstTable::word`] and [`StartPoint::word`].
    pub(crate) fn words(&self) -> anyhow::Result<Vec<String>> {
        let preset = [&self.preset].into_iter();
        let preset = preset.filter(|preset| !preset.is_empty() && *preset != DEFAULT_PRESET);
        let mut words: Vec<String> = preset.chain(&self.set).cloned().collect();
        words.extend(self.table.as_ref().map(FirstTable::word).transpose()?);
        words.extend(self.start.as_ref().map(StartPoint::word).transpose()?);
        Ok(words)
    }

    /// Returns the search space of the run.
    ///
    /// # Errors
    /// As [`Space::new`] and [`Space::with_start`].
    pub fn space(&self, case: &Case) -> Result<Space, SpaceError> {
        space(case, self.start.as_ref())
    }

    /// Returns the folder of the measured records if they do not come from the case folder.
    pub fn replaced_records(&self) -> Option<&Path> {
        let measured = Path::new(&self.measured);
        let of_case = std::path::absolute(measured).is_ok_and(|path| path == self.case_folder)
            || self.case_folder.ends_with(measured);
        (!of_case).then_some(measured)
    }
}

impl<S: RunIdentity> Manifest<S> {
    /// Creates the manifest of a new run with the measured records of the case, no preset, and the
    /// recommended values as start.
    ///
    /// # Errors
    /// If the current folder, to which the case folder is relative, does not exist.
    pub fn new(case_folder: &Path, seed: u64, settings: S) -> anyhow::Result<Self> {
        Ok(Self {
            kind: S::KIND.to_owned(),
            format: FORMAT,
            program: PROGRAM.to_owned(),
            command: command_line(),
            preset: String::new(),
            set: Vec::new(),
            seed,
            settings,
            start: None,
            table: None,
            assessed: None,
            case_folder: std::path::absolute(case_folder)?,
            measured: case_folder.display().to_string(),
            synthetic: false,
            notes: Vec::new(),
            effects: Vec::new(),
            wall_s: 0.0,
        })
    }

    /// Returns everything that determines the result of the run as canonical JSON; a journal with a different
    /// text refuses the run.
    ///
    /// # Errors
    /// If the settings cannot be encoded.
    pub fn settings_json(&self) -> anyhow::Result<String> {
        let identity = Identity {
            seed: self.seed,
            settings: &self.settings,
            start: self.start_genes(),
            families: self.families(),
            table: self.first_individuals(),
        };
        Ok(serde_json::to_string(&identity)?)
    }

    /// Returns the command that resumes the run in its present folder.
    pub fn resume_command(&self, folder: &Path) -> String {
        let subject = self.assessed.as_ref().unwrap_or(&self.case_folder);
        let about = self.settings.command(&quote_path(subject));
        let mut command = format!("horsehead {about}");
        if !self.preset.is_empty() {
            command.extend([" --preset ", &quote(&self.preset)]);
        }
        for set in &self.set {
            command.extend([" --set ", set]);
        }
        if S::SEEDED {
            command.extend([" --seed ", &self.seed.to_string()]);
        }
        command.extend([" --run ", &quote_path(folder)]);
        command.push_str(&self.settings.arguments());
        if let Some(start) = &self.start {
            command.extend([" --genes ", &quote_path(&start.file)]);
        }
        // those of an assessed run are its own
        let records = self.replaced_records();
        if let Some(records) = records.filter(|_| self.assessed.is_none()) {
            command.extend([" --measured ", &quote_path(records)]);
        }
        command
    }
}

/// Returns the search space of the case's unknowns, centred on the recommended values or on those of a start.
///
/// # Errors
/// As [`Space::new`] and [`Space::with_start`].
pub fn space(case: &Case, start: Option<&StartPoint>) -> Result<Space, SpaceError> {
    match start {
        None => Space::new(&case.unknowns),
        Some(start) => Space::with_start(&case.unknowns, &start.genes),
    }
}
