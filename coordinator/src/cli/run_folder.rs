//! The folder of a calibration: where its files lie and what is remembered of how it was begun.
//!
//! `run.json` and `case.json` make the folder independent of the case folder: `verify` and
//! `report` need nothing else. The journal, which the dispatcher keeps in the same folder, holds
//! every result.
use super::problem::Usage;
use crate::journal;
use anyhow::Context as _;
use protocol::case::Case;
use search::strategy::Settings;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Version of the two files.
const FORMAT: u32 = 1;

/// How a run was begun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Manifest {
    /// Version of this file.
    pub(super) format: u32,
    /// Program and version that began the run.
    pub(super) program: String,
    /// Command line that begins, and continues, the run.
    pub(super) command: String,
    /// Preset that the settings come from.
    pub(super) preset: String,
    /// Seed of every random choice.
    pub(super) seed: u64,
    /// Everything that decides the search.
    pub(super) settings: Settings,
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

impl Manifest {
    /// What decides the result, as canonical JSON: the journal refuses to mix two of them.
    pub(super) fn settings_json(&self) -> anyhow::Result<String> {
        Ok(serde_json::to_string(&(self.seed, &self.settings))?)
    }

    /// The command that goes on with the run in the folder where it lies now.
    pub(super) fn resume_command(&self, folder: &Path) -> String {
        let word = |path: &Path| quote(&path.display().to_string());
        let mut command = format!(
            "horsehead calibrate {} --preset {} --seed {} --run {}",
            word(&self.case_folder),
            quote(&self.preset),
            self.seed,
            word(folder)
        );
        if let Settings::Window(settings) = &self.settings {
            command.push_str(" --window ");
            command.push_str(&settings.window.to_string());
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

    /// A new manifest of this program.
    pub(super) const fn format() -> u32 {
        FORMAT
    }
}

/// A run folder.
#[derive(Clone, Debug)]
pub(super) struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// `runs/CASE-PRESET-seedN` below the current folder, so that the same command finds it.
    pub(super) fn default_path(case: &str, preset: &str, seed: u64) -> PathBuf {
        let word: String = case
            .chars()
            .map(|c| {
                if c.is_ascii_alphanumeric() {
                    c.to_ascii_lowercase()
                } else {
                    '-'
                }
            })
            .collect();
        Path::new("runs").join(format!("{word}-{preset}-seed{seed}"))
    }

    /// Whether a run can begin here, or go on because it is the same one. Writes nothing:
    /// [`RunFolder::spent`] does, once the journal has agreed.
    ///
    /// # Errors
    /// If the folder holds another run or something else.
    pub(super) fn begin(path: &Path, manifest: &Manifest, case: &Case) -> anyhow::Result<Begun> {
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
        let (earlier, earlier_case) = folder.load()?;
        let difference = if earlier.seed != manifest.seed {
            format!("its seed is {}, not {}", earlier.seed, manifest.seed)
        } else if earlier.settings != manifest.settings {
            format!(
                "its search settings differ (it was begun with preset {})",
                earlier.preset
            )
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

    /// Opens a run that was begun before.
    ///
    /// # Errors
    /// If the folder holds no run, or one of another version.
    pub(super) fn open(path: &Path) -> anyhow::Result<(Self, Manifest, Case)> {
        let folder = Self {
            path: path.to_owned(),
        };
        if !folder.file("run.json").exists() {
            return Err(Usage {
                message: format!("{} is no run folder: it has no run.json", path.display()),
                help: "`horsehead calibrate CASE` makes one below runs/".to_owned(),
            }
            .into());
        }
        let (manifest, case) = folder.load()?;
        Ok((folder, manifest, case))
    }

    fn load(&self) -> anyhow::Result<(Manifest, Case)> {
        let manifest: Manifest = self.read_json("run.json")?;
        if manifest.format != FORMAT {
            return Err(Usage {
                message: format!(
                    "{} was made by {}, in a form this version does not read",
                    self.path.display(),
                    manifest.program
                ),
                help: "use that version, or begin a new run with --run".to_owned(),
            }
            .into());
        }
        Ok((manifest, self.read_json("case.json")?))
    }

    /// Remembers how the run was begun and the time that was spent.
    pub(super) fn spent(
        &self,
        manifest: &Manifest,
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

    fn read_json<T: DeserializeOwned>(&self, name: &str) -> anyhow::Result<T> {
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

/// A gene file that `--genes` and the case loader read: one line per gene, exact values.
pub(super) fn gene_file(case: &Case, values: &[f64], about: &str) -> String {
    let mut text = format!("# {about}\n");
    for (gene, value) in case.genes.iter().zip(values) {
        let name = gene.name.as_str();
        let unit = gene.unit.symbol();
        let line = format!("{name:<4} = {{ value = {value:e}, unit = \"{unit}\" }}\n");
        text.push_str(&line);
    }
    text
}

/// The command line as it was typed, quoted where a shell needs it.
pub(super) fn command_line() -> String {
    let mut words = vec!["horsehead".to_owned()];
    words.extend(std::env::args().skip(1).map(|word| quote(&word)));
    words.join(" ")
}

fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
