//! Paths of the files in a run folder, and the remedy if one of them is damaged.
//!
//! `run.json`, `case.json` and the journal make the folder of a finished run independent of the case folder: `report`
//! and `export` read nothing else. The journal, which the dispatcher keeps in the same folder, holds the measured records
//! and every result.
use crate::{
    command_line::quote_path,
    manifest::{BALANCE, CALIBRATE, DIAGNOSE, FORMAT, LIFE, calibrate},
};
use anyhow::Context as _;
use case::{CaseEffect, write_genes};
use journal::event::Event;
use protocol::case::Case;
use report::MachineAssessment;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs, io,
    path::{Path, PathBuf},
};
use support::{Problem, atomic_file};

/// Name of the manifest file: how the run was begun, and the settings that determine its result.
pub const MANIFEST: &str = "run.json";
/// Name of the file with the case as it was when the run was begun.
pub const CASE: &str = "case.json";
/// Name of the file that holds the output of a finished run.
pub const RESULT: &str = "result.json";
/// Name of the gene file with the parameter values that a run found.
pub const GENES: &str = "calibrated.toml";

/// Name of the file with an assessment, by which the report of the assessed run shows it.
const ASSESSMENT: &str = "assessment.json";

/// Name of the folder that holds the keys of workers that the run itself launches.
pub(crate) const KEYS: &str = "keys";

/// Manifest fields that all kinds of run have in common.
#[derive(Debug, Deserialize)]
pub struct ManifestHeader {
    format: u32,
    program: String,
    /// Kind of the run, named after the command that created it.
    #[serde(default = "calibrate")]
    pub kind: String,
}

/// Folder of a run.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// Refers to a run folder by its path, without checking its content.
    pub fn new(path: &Path) -> Self {
        let path = path.to_owned();
        Self { path }
    }

    /// Opens the folder of a run of any kind.
    ///
    /// # Errors
    /// If the folder contains no run.
    pub fn at(path: &Path) -> Result<Self, Problem> {
        let folder = Self::new(path);
        if folder.is_begun() {
            return Ok(folder);
        }
        Err(Problem {
            message: format!("{} is no run folder: it has no {MANIFEST}", path.display()),
            remedy:
                "name a folder below runs/ that `horsehead calibrate CASE` or `horsehead diagnose CASE` has written"
                    .to_owned(),
        })
    }

    /// Reads the common fields of the manifest.
    ///
    /// # Errors
    /// If the manifest is damaged or has a format that this version does not read.
    pub fn head(&self) -> anyhow::Result<ManifestHeader> {
        let head: ManifestHeader = self.read_json(MANIFEST)?;
        if head.format == FORMAT {
            return Ok(head);
        }
        Err(Problem {
            message: format!(
                "{} was written by {}, in a format that this version cannot read",
                self.path.display(),
                head.program
            ),
            remedy: "use that version, or begin a new run with --run".to_owned(),
        }
        .into())
    }

    /// Checks that a new run can be begun in the folder.
    ///
    /// # Errors
    /// If the path is not a folder, or the folder contains unrelated files.
    pub fn check_vacant(&self) -> Result<(), Problem> {
        let path = self.path.display();
        let help = "choose an empty or new folder with --run DIR".to_owned();
        // the lock and keys alone are left where a run could not begin
        let vacant = fs::read_dir(&self.path).map(|entries| {
            let mut names = entries.flatten().map(|entry| entry.file_name());
            names.all(|name| name == journal::LOCK || name == KEYS)
        });
        match vacant {
            Ok(false) if !self.file(journal::FILE).exists() => Err(Problem {
                message: format!("{path} is not empty, and no run was begun in it"),
                remedy: help,
            }),
            Ok(_) => Ok(()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(Problem {
                message: format!("{path} cannot be a run folder: {error}"),
                remedy: help,
            }),
        }
    }

    /// Returns whether a run was begun in the folder.
    pub fn is_begun(&self) -> bool {
        self.file(MANIFEST).exists()
    }

    /// Returns whether the run in the folder has finished.
    pub fn is_finished(&self) -> bool {
        self.file(RESULT).exists()
    }

    /// Returns whether the folder contains a journal that is not empty.
    pub(crate) fn has_journal(&self) -> bool {
        fs::metadata(self.file(journal::FILE)).is_ok_and(|file| file.len() > 0)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of the file called `name` in the run folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a value as a JSON file into the run folder.
    ///
    /// # Errors
    /// If the value cannot be encoded, or the file cannot be written.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> anyhow::Result<()> {
        let mut text = serde_json::to_string_pretty(value)?;
        text.push('\n');
        self.write(name, &text)
    }

    /// Writes the assessment of a machine into its run folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_assessment(&self, assessment: &MachineAssessment) -> anyhow::Result<()> {
        self.write_json(ASSESSMENT, assessment)
    }

    /// Reads the assessments that were made of the run in the folder.
    ///
    /// # Errors
    /// If the file of one is damaged.
    pub(crate) fn assessments(&self) -> anyhow::Result<Vec<MachineAssessment>> {
        let folders = [LIFE, BALANCE].map(|kind| Self::new(&self.file(kind)));
        let made = folders.iter().filter(|own| own.file(ASSESSMENT).exists());
        made.map(|own| own.read_json(ASSESSMENT)).collect()
    }

    /// Writes values of a case's unknowns as a gene file into the run folder, with the effects with which they
    /// were found; the line `about` states their source.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write_genes(
        &self,
        case: &Case,
        genes: &[f64],
        effects: &[CaseEffect],
        about: &str,
    ) -> anyhow::Result<()> {
        self.write(GENES, write_genes(case, genes, effects, about))?;
        if let Some((name, text)) = case::kind::of(case).gene_file(case, genes) {
            self.write(name, &text)?;
        }
        Ok(())
    }

    /// Writes a file of the run folder atomically: a concurrent reader finds either the old or the new
    /// content.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> anyhow::Result<()> {
        let file = self.file(name);
        let written = atomic_file::replace(&file, content.as_ref());
        written.with_context(|| format!("cannot write {}", file.display()))
    }

    /// Reads a JSON file of the run folder.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged; the remedy restores it from the journal.
    pub fn read_json<T: DeserializeOwned>(&self, name: &str) -> anyhow::Result<T> {
        let file = self.file(name);
        let damaged = |why: &dyn std::fmt::Display| Problem {
            message: format!("{} is damaged: {why}", file.display()),
            remedy: self.repair(),
        };
        let text = fs::read_to_string(&file).map_err(|error| damaged(&error))?;
        Ok(serde_json::from_str(&text).map_err(|error| damaged(&error))?)
    }

    /// Returns the remedy for a damaged manifest or case file, with the command that created the run as read
    /// from the journal.
    fn repair(&self) -> String {
        let mut kind = None;
        // a journal that cannot be read says nothing, which is answered below
        let _unread = journal::fold(&self.file(journal::HEAD), |_, event| {
            if let Event::Begun { header, .. } = event {
                kind = Some(header.kind);
            }
        });
        let folder = quote_path(&self.path);
        let command = match kind.as_deref() {
            Some(DIAGNOSE) => format!("horsehead diagnose CASE --seed N --run {folder}"),
            Some(CALIBRATE) => {
                format!("horsehead calibrate CASE --preset NAME --seed N --run {folder}")
            }
            Some(_) | None => format!("(the same command as before, with --run {folder})"),
        };
        format!(
            "the results are in the journal: remove {MANIFEST} and {CASE}, and repeat the command \
             that began the run:\n  rm -f {folder}/{MANIFEST} {folder}/{CASE}\n  {command}"
        )
    }
}
