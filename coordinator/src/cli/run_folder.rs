//! The folder of a calibration: where its files lie and what is remembered of how it was begun.
//!
//! `run.json` and `case.json` make the folder independent of the case folder: `verify` and
//! `report` need nothing else. The journal, which the dispatcher keeps in the same folder, holds
//! every result.
use super::problem::Usage;
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

    /// Begins a run, or goes on with it if it is the same one.
    ///
    /// # Errors
    /// If the folder holds another run, or cannot be written.
    pub(super) fn begin(path: &Path, manifest: &Manifest, case: &Case) -> anyhow::Result<Begun> {
        let folder = Self {
            path: path.to_owned(),
        };
        if !folder.file("run.json").exists() {
            folder.check_empty()?;
            let unusable = |error: &dyn std::fmt::Display| Usage {
                message: format!("{} cannot hold a run: {error}", path.display()),
                help: "give another folder with --run, one that you may write to".to_owned(),
            };
            fs::create_dir_all(path).map_err(|error| unusable(&error))?;
            fs::write(folder.file(".writable"), "")
                .and_then(|()| fs::remove_file(folder.file(".writable")))
                .map_err(|error| unusable(&error))?;
            folder.write_json("case.json", case)?;
            folder.write_json("run.json", manifest)?;
            return Ok(Begun {
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
            return Ok(Begun {
                folder,
                resumed: true,
                wall_s: earlier.wall_s,
            });
        };
        Err(Usage {
            message: format!("{} holds another run: {difference}", path.display()),
            help: format!(
                "choose another folder with --run, or go on with that run:\n  {}",
                earlier.command
            ),
        }
        .into())
    }

    /// Refuses a folder of somebody else's: a run would scatter its files among theirs.
    fn check_empty(&self) -> Result<(), Usage> {
        let mut names = fs::read_dir(&self.path)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.file_name().to_string_lossy().into_owned());
        // an interrupted beginning leaves no more than these
        let ours = ["case.json", ".case.json.new", ".run.json.new", ".writable"];
        names
            .find(|name| !ours.contains(&name.as_str()))
            .map_or(Ok(()), |name| {
                Err(Usage {
                    message: format!(
                        "{} is not empty and holds no run (it has {name}, no run.json)",
                        self.path.display()
                    ),
                    help: "give a new or an empty folder with --run".to_owned(),
                })
            })
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

    /// Remembers the time that was spent.
    pub(super) fn spent(&self, manifest: &Manifest, wall_s: f64) -> anyhow::Result<()> {
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
        let text = text.with_context(|| format!("cannot read {}", file.display()))?;
        serde_json::from_str(&text).map_err(|error| {
            Usage {
                message: format!("{} is damaged: {error}", file.display()),
                help: "begin a new run in another folder with --run; the journal beside it keeps \
                       the results of this one"
                    .to_owned(),
            }
            .into()
        })
    }
}

/// A run that may go on.
#[derive(Debug)]
pub(super) struct Begun {
    /// Its folder.
    pub(super) folder: RunFolder,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_of_somebody_else_is_refused_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let run = RunFolder {
            path: folder.path().to_owned(),
        };
        run.check_empty().unwrap();
        fs::write(run.file("case.json"), "{").unwrap();
        run.check_empty().expect("an interrupted beginning goes on");
        fs::write(run.file("thesis.tex"), "").unwrap();
        let refused = run.check_empty().unwrap_err();
        assert!(
            refused.message.contains("thesis.tex"),
            "{}",
            refused.message
        );
        assert!(refused.help.contains("--run"));
    }
}
