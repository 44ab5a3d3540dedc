//! Run with its folder, manifest and case: opening, resuming and comparing runs.
use crate::{
    folder::{CASE, GENES, MANIFEST, RunFolder},
    hash,
    manifest::{Manifest, RunIdentity},
};
use case::{Loaded, Overrides, difference::differences, load_with_notes};
use protocol::case::Case;
use report::Origin;
use std::path::{Path, PathBuf};
use study::RecordError;
use support::Problem;

/// Run of one kind; `S` is the type of the settings that, with case, seed and start, determine its result.
#[derive(Clone, Debug)]
pub struct Run<S> {
    /// Folder in which the run keeps its manifest, case, journal and results.
    pub folder: RunFolder,
    /// Manifest: how the run was begun, with the wall time of its finished sessions.
    pub manifest: Manifest<S>,
    /// Case of the run, as it was when the run was begun.
    pub case: Case,
}

impl<S: RunIdentity> Run<S> {
    /// Opens the existing run in a folder.
    ///
    /// # Errors
    /// If the folder holds no run, or one of another version or kind.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        Self::load(RunFolder::at(path)?)
    }

    fn load(folder: RunFolder) -> anyhow::Result<Self> {
        let head = folder.head()?;
        if head.kind != S::KIND {
            return Err(Problem {
                message: format!(
                    "{} holds a run of `horsehead {}`, not of `horsehead {}`",
                    folder.path().display(),
                    head.kind,
                    S::KIND
                ),
                remedy: "name the folder of another run, or begin a new one with --run DIR"
                    .to_owned(),
            }
            .into());
        }
        Ok(Self {
            manifest: folder.read_json(MANIFEST)?,
            case: folder.read_json(CASE)?,
            folder,
        })
    }

    /// Prepares a new run in a vacant folder, or resumes the same run in its folder. Writes nothing:
    /// [`Run::save`] does so once the journal has been accepted.
    ///
    /// # Errors
    /// If the folder holds another run or unrelated files.
    pub fn begin(path: &Path, manifest: Manifest<S>, case: Case) -> anyhow::Result<Self> {
        let folder = RunFolder::new(path);
        let mut run = Self {
            folder,
            manifest,
            case,
        };
        if !run.folder.is_begun() {
            run.folder.check_vacant()?;
            return Ok(run);
        }
        let earlier = Self::load(run.folder.clone())?;
        if let Some(difference) = run.difference(&earlier) {
            return Err(Problem {
                message: format!("{} holds another run: {difference}", path.display()),
                remedy: format!(
                    "choose another folder with --run, or go on with that run:\n  {}",
                    earlier.resume_command()
                ),
            }
            .into());
        }
        let changes = differences(&earlier.case, &run.case);
        if !changes.is_empty() {
            return Err(run.changed(&changes).into());
        }
        run.manifest.wall_s = earlier.manifest.wall_s;
        // of the case and the gene file as they were
        run.manifest.notes = earlier.manifest.notes;
        Ok(run)
    }

    /// Describes the first difference in seed, start or settings between this run and an earlier one; `None`
    /// if there is none.
    fn difference(&self, earlier: &Self) -> Option<String> {
        let (was, is) = (&earlier.manifest, &self.manifest);
        if was.seed != is.seed {
            Some(format!("its seed is {}, not {}", was.seed, is.seed))
        } else if was.start_genes() != is.start_genes() || was.families() != is.families() {
            Some("it starts at other genes".to_owned())
        } else if was.first_individuals() != is.first_individuals() {
            Some(match &was.table {
                Some(table) => format!(
                    "it begins with other individuals, those that {} held",
                    table.file.display()
                ),
                None => "it begins without a table of individuals".to_owned(),
            })
        } else if was.settings != is.settings {
            let difference = is.settings.difference(&was.settings);
            Some(match was.preset.as_str() {
                "" => difference,
                preset => format!("{difference} (it was begun with preset {preset})"),
            })
        } else {
            None
        }
    }

    /// Returns the provenance of the run's results as shown in reports; `digest`, the hash of the evaluation
    /// log, may be empty.
    ///
    /// # Errors
    /// If the case cannot be encoded.
    pub fn origin(&self, digest: String) -> anyhow::Result<Origin> {
        let manifest = &self.manifest;
        Ok(Origin {
            program: manifest.program.clone(),
            command: manifest.command.clone(),
            run: self.folder.path().display().to_string(),
            case_hash: hash::case_hash(&self.case)?,
            measured_name: manifest.measured.clone(),
            preset: (!manifest.preset.is_empty()).then(|| manifest.preset.clone()),
            seed: S::SEEDED.then_some(manifest.seed),
            digest,
            synthetic: manifest.synthetic,
        })
    }

    /// Returns whether the run computed results but its journal is missing or empty.
    pub fn lost_journal(&self) -> bool {
        let computed = self.manifest.wall_s > 0.0 || self.folder.is_finished();
        self.folder.is_begun() && computed && !self.folder.has_journal()
    }

    /// Checks that the run has written the parameters that it found.
    ///
    /// # Errors
    /// If it is not finished; the error gives the command that finishes it.
    pub(crate) fn expect_parameters(&self) -> Result<&Self, Problem> {
        if self.folder.file(GENES).exists() {
            return Ok(self);
        }
        Err(Problem {
            message: format!("{} is not finished", self.folder.path().display()),
            remedy: format!("finish it first:\n  {}", self.resume_command()),
        })
    }

    /// Returns the path of the run's journal.
    ///
    /// # Errors
    /// If the journal is missing or empty; the error gives the command that computes the run again.
    pub(crate) fn expect_journal(&self) -> Result<PathBuf, Problem> {
        if self.folder.has_journal() {
            return Ok(self.folder.file(journal::FILE));
        }
        Err(Problem {
            message: format!(
                "the journal of {} is missing or empty",
                self.folder.path().display()
            ),
            remedy: format!(
                "restore the journal, or compute the run again:\n  {}",
                self.resume_command()
            ),
        })
    }

    /// Returns the error for a run whose result its journal does not hold, with the command that resumes the run.
    pub(crate) fn unreadable(&self, error: RecordError) -> anyhow::Error {
        let (what, remedy) = match error {
            RecordError::Journal(error) => return error.into(),
            RecordError::Unfinished => ("is not finished", "resume the run first"),
            RecordError::Incomplete => (
                "cannot be shown: its journal lacks results",
                "what is missing is computed again by the command of the run",
            ),
        };
        Problem {
            message: format!("{} {what}", self.folder.path().display()),
            remedy: format!("{remedy}:\n  {}", self.resume_command()),
        }
        .into()
    }

    /// Writes the case and the manifest into the run folder, with the wall time spent so far (s).
    ///
    /// # Errors
    /// As [`RunFolder::write_json`].
    pub fn save(&self, wall_s: f64) -> anyhow::Result<()> {
        if !self.folder.file(CASE).exists() {
            self.folder.write_json(CASE, &self.case)?;
        }
        let manifest = Manifest {
            wall_s,
            ..self.manifest.clone()
        };
        self.folder.write_json(MANIFEST, &manifest)
    }

    /// Returns the command that resumes the run.
    pub fn resume_command(&self) -> String {
        self.manifest.resume_command(self.folder.path())
    }

    /// Loads the case of the run with its measured cycles, which the run folder does not contain.
    ///
    /// # Errors
    /// If the case has changed since the run was begun.
    pub fn loaded(&self) -> anyhow::Result<Loaded> {
        let manifest = &self.manifest;
        let overrides = Overrides {
            measured: manifest.replaced_records().map(ToOwned::to_owned),
        };
        let mut loaded = self.as_begun(load_with_notes(&manifest.case_folder, &overrides)?)?;
        if let Some(start) = &manifest.start {
            loaded.take_effects(&start.effects);
        }
        let changes = differences(&self.case, &loaded.case);
        if !changes.is_empty() {
            return Err(self.changed(&changes).into());
        }
        Ok(loaded)
    }

    /// Returns the error for a run whose case has changed; its remedy names a new run folder, because
    /// repeating the command would fail again.
    fn changed(&self, changes: &str) -> Problem {
        let manifest = &self.manifest;
        let path = self.folder.path();
        let another = manifest.resume_command(&unused(path));
        Problem {
            message: format!(
                "the case has changed since {} was begun: {changes}",
                path.display()
            ),
            remedy: format!(
                "a run belongs to one case; restore {}, or begin a new run of the changed case:\n  {another}",
                manifest.case_folder.display()
            ),
        }
    }

    /// Removes from a loaded case the effects that this diagnosis has added to it since it was begun.
    pub(crate) fn as_begun(&self, loaded: Loaded) -> anyhow::Result<Loaded> {
        Ok(loaded.without_effects_from(&hash::case_hash(&self.case)?))
    }
}

/// Returns the first path of the form `NAME-2`, `NAME-3`, ... that does not exist yet.
fn unused(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let numbered = |number: u32| path.with_file_name(format!("{name}-{number}"));
    let mut free = (2..1000).map(numbered).filter(|path| !path.exists());
    free.next().unwrap_or_else(|| path.to_owned())
}
