//! The folder of a run: where its files lie and what is remembered of how it was begun.
//!
//! `run.json` and `case.json` make the folder independent of the case folder: `verify` and
//! `report` need nothing else. The journal, which the dispatcher keeps in the same folder, holds
//! every result.
use super::{bus::content_hash, problem::Usage};
use crate::{case::read_genes, journal};
use anyhow::Context as _;
use protocol::case::Case;
use search::{
    space::{Space, SpaceError},
    strategy::Settings,
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Version of the two files.
const FORMAT: u32 = 1;

/// The kind of a calibration; folders that name none hold one.
pub(super) const CALIBRATE: &str = "calibrate";
/// The kind of a diagnosis.
pub(super) const DIAGNOSE: &str = "diagnose";

fn calibrate() -> String {
    CALIBRATE.to_owned()
}

/// How a run was begun; `S` is everything that decides its result beside case and seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Manifest<S = Settings> {
    /// The command that it belongs to.
    #[serde(default = "calibrate")]
    pub(super) kind: String,
    /// Version of this file.
    pub(super) format: u32,
    /// Program and version that began the run.
    pub(super) program: String,
    /// Command line that begins, and continues, the run.
    pub(super) command: String,
    /// Preset that the settings come from; empty where there are none.
    pub(super) preset: String,
    /// Seed of every random choice.
    pub(super) seed: u64,
    /// Everything that decides the result beside seed and start.
    pub(super) settings: S,
    /// Where it starts, if not at the recommended values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<Start>,
    /// Where the case was read from.
    pub(super) case_folder: PathBuf,
    /// Where the records came from.
    pub(super) measured: String,
    /// Whether the case says that they were computed, not measured.
    #[serde(default)]
    pub(super) synthetic: bool,
    /// Remarks about the case.
    pub(super) notes: Vec<String>,
    /// Wall time of the sessions that are over (s).
    pub(super) wall_s: f64,
}

/// Values of the case's genes that a run starts at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Start {
    /// The gene file that they come from.
    pub(super) file: PathBuf,
    /// One value per gene [declared units].
    pub(super) genes: Vec<f64>,
}

impl Start {
    /// Reads a gene file, if there is one.
    ///
    /// # Errors
    /// As [`read_genes`].
    pub(super) fn read(file: Option<&Path>, case: &Case) -> anyhow::Result<Option<Self>> {
        let read = |file: &Path| -> anyhow::Result<Self> {
            Ok(Self {
                file: std::path::absolute(file)?,
                genes: read_genes(file, case)?,
            })
        };
        file.map(read).transpose()
    }
}

impl<S: Decides> Manifest<S> {
    /// What decides the result, as canonical JSON: the journal refuses to mix two of them.
    pub(super) fn settings_json(&self) -> anyhow::Result<String> {
        let Self { seed, settings, .. } = self;
        Ok(match self.start_genes() {
            None => serde_json::to_string(&(seed, settings))?,
            Some(genes) => serde_json::to_string(&(seed, settings, genes))?,
        })
    }

    /// Values of the case's genes that the run starts at, if not the recommended ones.
    pub(super) fn start_genes(&self) -> Option<&[f64]> {
        self.start.as_ref().map(|start| start.genes.as_slice())
    }

    /// The space that it searches.
    ///
    /// # Errors
    /// As [`Space::new`] and [`Space::about`].
    pub(super) fn space(&self, case: &Case) -> Result<Space, SpaceError> {
        space(case, self.start.as_ref())
    }

    /// The command that goes on with the run in the folder where it lies now.
    pub(super) fn resume_command(&self, folder: &Path) -> String {
        let word = |path: &Path| quote(&path.display().to_string());
        let mut command = format!("horsehead {} {}", self.kind, word(&self.case_folder));
        if !self.preset.is_empty() {
            command.push_str(" --preset ");
            command.push_str(&quote(&self.preset));
        }
        let seed = self.seed.to_string();
        command.extend([" --seed ", &seed, " --run ", &word(folder)]);
        command.push_str(&self.settings.arguments());
        if let Some(start) = &self.start {
            command.extend([" --genes ", &word(&start.file)]);
        }
        let measured = Path::new(&self.measured);
        let of_case = std::path::absolute(measured).is_ok_and(|path| path == self.case_folder)
            || self.case_folder.ends_with(measured);
        if !of_case {
            command.push_str(" --measured ");
            command.push_str(&quote(&self.measured));
        }
        command
    }
}

/// The space of a case's genes, about the recommended values or those of a start.
///
/// # Errors
/// As [`Space::new`] and [`Space::about`].
pub(super) fn space(case: &Case, start: Option<&Start>) -> Result<Space, SpaceError> {
    match start {
        None => Space::new(&case.genes),
        Some(start) => Space::about(&case.genes, &start.genes),
    }
}

/// Version of the manifests of this program.
pub(super) const fn format() -> u32 {
    FORMAT
}

/// Settings that a manifest may hold.
pub(super) trait Decides: Serialize + DeserializeOwned + PartialEq + Clone {
    /// What of them a command line must repeat beside preset and seed, with a space before it.
    fn arguments(&self) -> String {
        String::new()
    }
}

impl Decides for Settings {
    fn arguments(&self) -> String {
        match self {
            Self::Window(settings) => format!(" --window {}", settings.window),
            Self::Memetic(_) | Self::Quick(_) => String::new(),
        }
    }
}

/// What every manifest says, whatever kind of run it is of.
#[derive(Debug, Deserialize)]
struct Head {
    format: u32,
    program: String,
    #[serde(default = "calibrate")]
    kind: String,
}

/// A run folder.
#[derive(Clone, Debug)]
pub(super) struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// `runs/CASE-WHAT[-RECORDS-HASH]-seedN` below the current folder, so that the same command finds it.
    /// `measured` is the folder of records that replace the case's: many folders have the same name, so
    /// the start of the records' hash tells them apart.
    pub(super) fn default_path(
        case: &Case,
        what: &str,
        measured: Option<&Path>,
        seed: u64,
    ) -> anyhow::Result<PathBuf> {
        let name = case.name.chars();
        let word: String = name
            .map(|c| {
                if c.is_ascii_alphanumeric() {
                    c.to_ascii_lowercase()
                } else {
                    '-'
                }
            })
            .collect();
        let records = match measured {
            None => String::new(),
            Some(folder) => {
                let name = folder
                    .file_name()
                    .map_or_else(String::new, |name| format!("-{}", name.to_string_lossy()));
                let hash = content_hash(&case.conditions)?.to_string();
                format!("{name}-{}", hash.get(..8).unwrap_or_default())
            }
        };
        let folder = format!("{word}-{what}{records}-seed{seed}");
        Ok(Path::new("runs").join(folder))
    }

    /// Whether a run can begin here, or go on because it is the same one. Writes nothing:
    /// [`RunFolder::spent`] does, once the journal has agreed.
    ///
    /// # Errors
    /// If the folder holds another run or something else.
    pub(super) fn begin<S: Decides>(
        path: &Path,
        manifest: &Manifest<S>,
        case: &Case,
    ) -> anyhow::Result<Begun> {
        let folder = Self {
            path: path.to_owned(),
        };
        if !folder.file("run.json").exists() {
            folder.check_vacant()?;
            return Ok(Begun {
                lost_journal: false,
                folder,
                resumed: false,
                wall_s: 0.0,
            });
        }
        let (earlier, earlier_case) = folder.load::<S>(&manifest.kind)?;
        let difference = if earlier.seed != manifest.seed {
            format!("its seed is {}, not {}", earlier.seed, manifest.seed)
        } else if earlier.start_genes() != manifest.start_genes() {
            "it starts at other genes".to_owned()
        } else if earlier.settings != manifest.settings {
            match earlier.preset.as_str() {
                "" => "its settings differ".to_owned(),
                preset => format!("its search settings differ (it was begun with preset {preset})"),
            }
        } else if earlier_case != *case {
            "its case or its records differ".to_owned()
        } else {
            let computed = earlier.wall_s > 0.0 || folder.is_finished();
            return Ok(Begun {
                lost_journal: computed && !folder.has_journal(),
                folder,
                resumed: true,
                wall_s: earlier.wall_s,
            });
        };
        Err(Usage {
            message: format!("{} holds another run: {difference}", path.display()),
            help: format!(
                "choose another folder with --run, or go on with that run:\n  {}",
                earlier.resume_command(path)
            ),
        }
        .into())
    }

    /// Refuses what is no folder, or is one with files of something else.
    fn check_vacant(&self) -> Result<(), Usage> {
        let path = self.path.display();
        let help = "choose an empty or new folder with --run DIR".to_owned();
        // the lock alone is left where a run could not begin
        let vacant = fs::read_dir(&self.path).map(|entries| {
            entries
                .flatten()
                .all(|entry| entry.file_name() == journal::LOCK)
        });
        match vacant {
            Ok(false) if !self.file(journal::FILE).exists() => Err(Usage {
                message: format!("{path} is not empty, and no run was begun in it"),
                help,
            }),
            Ok(_) => Ok(()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(Usage {
                message: format!("{path} cannot be a run folder: {error}"),
                help,
            }),
        }
    }

    /// Whether a journal with anything in it is there.
    pub(super) fn has_journal(&self) -> bool {
        fs::metadata(self.file(journal::FILE)).is_ok_and(|file| file.len() > 0)
    }

    /// Makes sure that the run can be replayed: it is finished and its journal is there.
    ///
    /// # Errors
    /// If not; the error says how to go on.
    pub(super) fn expect_replayable<S: Decides>(
        &self,
        manifest: &Manifest<S>,
    ) -> Result<(), Usage> {
        let path = self.path.display();
        let (message, remedy) = if !self.is_finished() {
            (format!("{path} is not finished"), "go on with it first")
        } else if !self.has_journal() {
            (
                format!("the journal of {path} is gone or empty"),
                "put it back, or compute the run anew",
            )
        } else {
            return Ok(());
        };
        Err(Usage {
            message,
            help: format!("{remedy}:\n  {}", manifest.resume_command(&self.path)),
        })
    }

    /// The folder of a run of any kind.
    ///
    /// # Errors
    /// If no run was begun there.
    pub(super) fn at(path: &Path) -> Result<Self, Usage> {
        let folder = Self {
            path: path.to_owned(),
        };
        if folder.file("run.json").exists() {
            return Ok(folder);
        }
        Err(Usage {
            message: format!("{} is no run folder: it has no run.json", path.display()),
            help: "`horsehead calibrate CASE` and `horsehead diagnose CASE` make them below runs/"
                .to_owned(),
        })
    }

    /// Opens a run that was begun before.
    ///
    /// # Errors
    /// If the folder holds no run, or one of another version or kind.
    pub(super) fn open<S: Decides>(
        path: &Path,
        kind: &str,
    ) -> anyhow::Result<(Self, Manifest<S>, Case)> {
        let folder = Self::at(path)?;
        let (manifest, case) = folder.load(kind)?;
        Ok((folder, manifest, case))
    }

    /// The kind of run that a folder holds, if it holds one.
    pub(super) fn kind(path: &Path) -> Option<String> {
        let folder = Self {
            path: path.to_owned(),
        };
        folder
            .read_json::<Head>("run.json")
            .ok()
            .map(|head| head.kind)
    }

    fn load<S: Decides>(&self, kind: &str) -> anyhow::Result<(Manifest<S>, Case)> {
        let head: Head = self.read_json("run.json")?;
        if head.format != FORMAT {
            return Err(Usage {
                message: format!(
                    "{} was made by {}, in a form this version does not read",
                    self.path.display(),
                    head.program
                ),
                help: "use that version, or begin a new run with --run".to_owned(),
            }
            .into());
        }
        if head.kind != kind {
            return Err(Usage {
                message: format!(
                    "{} holds a run of `horsehead {}`, not of `horsehead {kind}`",
                    self.path.display(),
                    head.kind
                ),
                help: "name the folder of another run, or begin a new one with --run DIR"
                    .to_owned(),
            }
            .into());
        }
        Ok((self.read_json("run.json")?, self.read_json("case.json")?))
    }

    /// Remembers how the run was begun and the time that was spent.
    pub(super) fn spent<S: Decides>(
        &self,
        manifest: &Manifest<S>,
        case: &Case,
        wall_s: f64,
    ) -> anyhow::Result<()> {
        if !self.file("case.json").exists() {
            self.write_json("case.json", case)?;
        }
        self.write_json(
            "run.json",
            &Manifest {
                wall_s,
                ..manifest.clone()
            },
        )
    }

    /// The folder.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// A file in it.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Whether the run came to its end.
    pub(super) fn is_finished(&self) -> bool {
        self.file("result.json").exists()
    }

    /// Writes a file as JSON.
    pub(super) fn write_json(&self, name: &str, value: &impl Serialize) -> anyhow::Result<()> {
        let mut text = serde_json::to_string_pretty(value)?;
        text.push('\n');
        self.write(name, &text)
    }

    /// Writes a file as a whole: whoever reads it finds the old one or the new one.
    pub(super) fn write(&self, name: &str, text: &str) -> anyhow::Result<()> {
        let (file, draft) = (self.file(name), self.file(&format!(".{name}.new")));
        let result: io::Result<()> =
            fs::write(&draft, text).and_then(|()| fs::rename(&draft, &file));
        result.with_context(|| format!("cannot write {}", file.display()))
    }

    pub(super) fn read_json<T: DeserializeOwned>(&self, name: &str) -> anyhow::Result<T> {
        let file = self.file(name);
        let text = fs::read_to_string(&file);
        let damaged = |why: String| {
            let folder = self.path.display();
            Usage {
                message: format!("{} is damaged: {why}", file.display()),
                help: format!(
                    "the results are in the journal: remove run.json and case.json, and repeat \
                     the command that began the run:\n  rm -f {folder}/run.json \
                     {folder}/case.json\n  horsehead calibrate CASE --preset NAME --seed N \
                     --run {folder}"
                ),
            }
        };
        let text = text.map_err(|error| damaged(error.to_string()))?;
        Ok(serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?)
    }
}

/// A run that may go on.
#[derive(Debug)]
pub(super) struct Begun {
    /// Its folder.
    pub(super) folder: RunFolder,
    /// Whether its results are gone although there were some.
    pub(super) lost_journal: bool,
    /// Whether it was begun earlier.
    pub(super) resumed: bool,
    /// Wall time of earlier sessions (s).
    pub(super) wall_s: f64,
}

/// The command line as it was typed, quoted where a shell needs it.
pub(super) fn command_line() -> String {
    let mut words = vec!["horsehead".to_owned()];
    words.extend(std::env::args().skip(1).map(|word| quote(&word)));
    words.join(" ")
}

/// A word as a shell takes it.
pub(super) fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
