//! A run that was begun: its folder, how it was begun, and its case.
use super::{
    bus,
    folder::{CASE, MANIFEST, RunFolder},
    manifest::{Decides, Manifest},
};
use crate::cli::output::problem::Problem;
use case::{Loaded, Overrides, difference::differences, load_with_notes};
use protocol::case::Case;
use report::Origin;
use std::path::{Path, PathBuf};

/// A run of one kind; `S` is what decides its result beside case, seed and start.
#[derive(Clone, Debug)]
pub(crate) struct Run<S> {
    /// Its folder.
    pub(crate) folder: RunFolder,
    /// How it was begun, with the wall time of the sessions that are over.
    pub(crate) manifest: Manifest<S>,
    /// Its case.
    pub(crate) case: Case,
}

impl<S: Decides> Run<S> {
    /// Opens a run that was begun before.
    ///
    /// # Errors
    /// If the folder holds no run, or one of another version or kind.
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
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

    /// A run in a folder where it can begin, or where it goes on because it is the same one. Writes
    /// nothing: [`Run::remember`] does, once the journal has agreed.
    ///
    /// # Errors
    /// If the folder holds another run or something else.
    pub(crate) fn begin(path: &Path, manifest: Manifest<S>, case: Case) -> anyhow::Result<Self> {
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
        Ok(run)
    }

    /// In what it is not the same run as an earlier one, in words.
    fn difference(&self, earlier: &Self) -> Option<String> {
        let (was, is) = (&earlier.manifest, &self.manifest);
        if was.seed != is.seed {
            Some(format!("its seed is {}, not {}", was.seed, is.seed))
        } else if was.start_genes() != is.start_genes() {
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

    /// Where its results come from, as reports say it; `digest` may be empty.
    pub(crate) fn origin(&self, digest: String) -> anyhow::Result<Origin> {
        let manifest = &self.manifest;
        Ok(Origin {
            program: manifest.program.clone(),
            command: manifest.command.clone(),
            run: self.folder.path().display().to_string(),
            case_hash: bus::case_hash(&self.case)?,
            measured_name: manifest.measured.clone(),
            preset: (!manifest.preset.is_empty()).then(|| manifest.preset.clone()),
            seed: Some(manifest.seed),
            digest,
            synthetic: manifest.synthetic,
        })
    }

    /// Whether its results are gone although there were some.
    pub(crate) fn lost_journal(&self) -> bool {
        let computed = self.manifest.wall_s > 0.0 || self.folder.is_finished();
        self.folder.is_begun() && computed && !self.folder.has_journal()
    }

    /// Makes sure that the run can be replayed: it is finished and its journal is there.
    ///
    /// # Errors
    /// If not; the error says how to go on.
    pub(crate) fn expect_replayable(&self) -> Result<(), Problem> {
        let path = self.folder.path().display();
        let (message, remedy) = if !self.folder.is_finished() {
            (format!("{path} is not finished"), "go on with it first")
        } else if !self.folder.has_journal() {
            (
                format!("the journal of {path} is gone or empty"),
                "put it back, or compute the run anew",
            )
        } else {
            return Ok(());
        };
        Err(Problem {
            message,
            remedy: format!("{remedy}:\n  {}", self.resume_command()),
        })
    }

    /// Remembers how the run was begun and the wall time that was spent (s).
    pub(crate) fn remember(&self, wall_s: f64) -> anyhow::Result<()> {
        if !self.folder.file(CASE).exists() {
            self.folder.write_json(CASE, &self.case)?;
        }
        let manifest = Manifest {
            wall_s,
            ..self.manifest.clone()
        };
        self.folder.write_json(MANIFEST, &manifest)
    }

    /// The command that goes on with the run in the folder where it lies now.
    pub(crate) fn resume_command(&self) -> String {
        self.manifest.resume_command(self.folder.path())
    }

    /// The case with its records: a run keeps its case, but not the cycles of the records.
    ///
    /// # Errors
    /// If the case has changed since the run was begun.
    pub(crate) fn loaded(&self) -> anyhow::Result<Loaded> {
        let manifest = &self.manifest;
        let overrides = Overrides {
            measured: manifest.replaced_records().map(ToOwned::to_owned),
        };
        let loaded = self.as_begun(load_with_notes(&manifest.case_folder, &overrides)?)?;
        let changes = differences(&self.case, &loaded.case);
        if !changes.is_empty() {
            return Err(self.changed(&changes).into());
        }
        Ok(loaded)
    }

    /// Why a run cannot go on with a case that was changed: the same command would say the same again.
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
                "a run is of one case; put {} back as it was, or begin a run of the changed one:\n  {another}",
                manifest.case_folder.display()
            ),
        }
    }

    /// A case without what this very diagnosis has added to it.
    pub(crate) fn as_begun(&self, loaded: Loaded) -> anyhow::Result<Loaded> {
        Ok(loaded.without_found_in(&bus::case_hash(&self.case)?))
    }
}

/// The first folder beside one that is not there yet: its name with a number from 2 on.
fn unused(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let numbered = |number: u32| path.with_file_name(format!("{name}-{number}"));
    let mut free = (2..1000).map(numbered).filter(|path| !path.exists());
    free.next().unwrap_or_else(|| path.to_owned())
}
