//! How a run was begun: what decides its result, and the command that goes on with it.
use super::{
    bus,
    command_line::{command_line, quote, quote_path},
};
use case::read_genes;
use protocol::case::Case;
use search::{
    space::{Space, SpaceError},
    strategy::{CATALOGUE, Preset, Settings},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::path::{Path, PathBuf};

/// Version of the files that a run folder keeps of its manifest and its case.
pub(crate) const FORMAT: u32 = 1;

/// Most settings that are named one by one where two runs differ.
const MOST_NAMED: usize = 3;

/// The kind of a calibration; folders that name none hold one.
pub(crate) const CALIBRATE: &str = "calibrate";
/// The kind of a diagnosis.
pub(crate) const DIAGNOSE: &str = "diagnose";
/// The kind of an identification: what a record sees.
pub(crate) const IDENTIFY: &str = "identify";
/// The kind of a run of individuals that another program asks for.
pub(crate) const EVALUATE: &str = "evaluate";

/// The kind that a manifest without one has.
pub(crate) fn calibrate() -> String {
    CALIBRATE.to_owned()
}

/// What decides the result of a kind of run beside case, seed and start.
pub(crate) trait Decides: Serialize + DeserializeOwned + PartialEq + Clone {
    /// The command that runs of this kind belong to.
    const KIND: &'static str;
    /// Whether a seed is part of it.
    const SEEDED: bool = true;

    /// The command with what it is about, as a shell takes it; `case` is the folder of the case.
    fn command(&self, case: &str) -> String {
        [Self::KIND, " ", case].concat()
    }

    /// What of it a command line must repeat beside preset, settings and seed, each word after a
    /// space.
    fn arguments(&self) -> String {
        String::new()
    }

    /// In what these settings differ from those of an earlier run, in words.
    fn difference(&self, _earlier: &Self) -> String {
        "its settings differ".to_owned()
    }
}

impl Decides for Settings {
    const KIND: &'static str = CALIBRATE;

    fn difference(&self, earlier: &Self) -> String {
        let same = |preset: &&Preset| preset.strategy == self.strategy();
        let named = CATALOGUE.iter().filter(same).flat_map(Preset::named);
        let differences = named.filter_map(|one| {
            let (was, is) = (one.value(earlier)?, one.value(self)?);
            (was != is).then(|| format!("{} is {was}, not {is}", one.key))
        });
        let first: Vec<String> = differences.take(MOST_NAMED).collect();
        match first.as_slice() {
            [] => "its search settings differ".to_owned(),
            some => format!("its search settings differ: {}", some.join(", ")),
        }
    }
}

/// How a run was begun; `S` is everything that decides its result beside case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Manifest<S = Settings> {
    /// The command that it belongs to.
    #[serde(default = "calibrate")]
    pub(crate) kind: String,
    /// Version of this file.
    pub(crate) format: u32,
    /// Program and version that began the run.
    pub(crate) program: String,
    /// Command line that begins, and continues, the run.
    pub(crate) command: String,
    /// Preset that the settings come from; empty where there are none.
    pub(crate) preset: String,
    /// Settings that differ from the preset's, as `key=value`.
    #[serde(default)]
    pub(crate) set: Vec<String>,
    /// Seed of every random choice.
    pub(crate) seed: u64,
    /// Everything that decides the result beside seed and start.
    pub(crate) settings: S,
    /// Where it starts, if not at the recommended values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) start: Option<Start>,
    /// Individuals that its search evaluates first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) table: Option<FirstTable>,
    /// Where the case was read from.
    pub(crate) case_folder: PathBuf,
    /// Where the records came from.
    pub(crate) measured: String,
    /// Whether the case says that they were computed, not measured.
    #[serde(default)]
    pub(crate) synthetic: bool,
    /// Remarks about the case.
    pub(crate) notes: Vec<String>,
    /// Wall time of the sessions that are over (s).
    pub(crate) wall_s: f64,
}

/// What decides the result of a run beside its case.
#[derive(Serialize)]
struct Identity<'a, S> {
    seed: u64,
    settings: &'a S,
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    table: Option<&'a [Vec<f64>]>,
}

/// Individuals that a search evaluates first. A run keeps them, and goes on without their file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct FirstTable {
    /// The table that they come from.
    pub(crate) file: PathBuf,
    /// Values of all unknowns, row by row [declared units].
    pub(crate) individuals: Vec<Vec<f64>>,
}

/// Values of the case's genes that a run starts at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Start {
    /// The gene file that they come from.
    pub(crate) file: PathBuf,
    /// One value per gene [declared units].
    pub(crate) genes: Vec<f64>,
}

impl Start {
    /// Reads a gene file, if there is one.
    ///
    /// # Errors
    /// As [`read_genes`].
    pub(crate) fn read(file: Option<&Path>, case: &Case) -> anyhow::Result<Option<Self>> {
        let read = |file: &Path| -> anyhow::Result<Self> {
            Ok(Self {
                file: std::path::absolute(file)?,
                genes: read_genes(file, case)?,
            })
        };
        file.map(read).transpose()
    }
}

impl<S> Manifest<S> {
    /// Values of the case's genes that the run starts at, if not the recommended ones.
    pub(crate) fn start_genes(&self) -> Option<&[f64]> {
        self.start.as_ref().map(|start| start.genes.as_slice())
    }

    /// Individuals that its search evaluates first.
    pub(crate) fn first_individuals(&self) -> Option<&[Vec<f64>]> {
        let table = self.table.as_ref();
        table.map(|table| table.individuals.as_slice())
    }

    /// The space that it searches.
    ///
    /// # Errors
    /// As [`Space::new`] and [`Space::about`].
    pub(crate) fn space(&self, case: &Case) -> Result<Space, SpaceError> {
        space(case, self.start.as_ref())
    }

    /// The folder of records that replace those of the case, if any do.
    pub(crate) fn replaced_records(&self) -> Option<&Path> {
        let measured = Path::new(&self.measured);
        let of_case = std::path::absolute(measured).is_ok_and(|path| path == self.case_folder)
            || self.case_folder.ends_with(measured);
        (!of_case).then_some(measured)
    }
}

impl<S: Decides> Manifest<S> {
    /// Of a run that begins now, of a case with its own records, without a preset and from the recommended values.
    pub(crate) fn new(case_folder: &Path, seed: u64, settings: S) -> anyhow::Result<Self> {
        Ok(Self {
            kind: S::KIND.to_owned(),
            format: FORMAT,
            program: bus::PROGRAM.to_owned(),
            command: command_line(),
            preset: String::new(),
            set: Vec::new(),
            seed,
            settings,
            start: None,
            table: None,
            case_folder: std::path::absolute(case_folder)?,
            measured: case_folder.display().to_string(),
            synthetic: false,
            notes: Vec::new(),
            wall_s: 0.0,
        })
    }

    /// What decides the result, as canonical JSON: the journal refuses to mix two of them.
    pub(crate) fn settings_json(&self) -> anyhow::Result<String> {
        let identity = Identity {
            seed: self.seed,
            settings: &self.settings,
            start: self.start_genes(),
            table: self.first_individuals(),
        };
        Ok(serde_json::to_string(&identity)?)
    }

    /// The command that goes on with the run in the folder where it lies now.
    pub(crate) fn resume_command(&self, folder: &Path) -> String {
        let about = self.settings.command(&quote_path(&self.case_folder));
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
        if let Some(records) = self.replaced_records() {
            command.extend([" --measured ", &quote_path(records)]);
        }
        command
    }
}

/// The space of a case's genes, about the recommended values or those of a start.
///
/// # Errors
/// As [`Space::new`] and [`Space::about`].
pub(crate) fn space(case: &Case, start: Option<&Start>) -> Result<Space, SpaceError> {
    match start {
        None => Space::new(&case.unknowns),
        Some(start) => Space::about(&case.unknowns, &start.genes),
    }
}
