//! The folder of a run: where its files lie, and what to do where one of them is damaged.
//!
//! `run.json` and `case.json` make the folder independent of the case folder: `verify` and
//! `report` need nothing else. The journal, which the dispatcher keeps in the same folder, holds
//! every result.
use super::{
    bus::content_hash,
    command_line::quote_path,
    manifest::{CALIBRATE, DIAGNOSE, FORMAT, calibrate},
};
use crate::cli::output::{problem::Problem, terminal};
use anyhow::Context as _;
use case::write_genes;
use dispatch::journal::{self, Recording};
use protocol::{case::Case, event::Event};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs, io,
    path::{Path, PathBuf},
};
use support::atomic_file;

/// How a run was begun, and what decides its result.
pub(crate) const MANIFEST: &str = "run.json";
/// The case as it was when the run was begun.
pub(crate) const CASE: &str = "case.json";
/// The output of a run that came to its end.
pub(crate) const RESULT: &str = "result.json";
/// What the record sees of a calibration's unknowns.
pub(crate) const SEEN: &str = "seen.json";
/// The parameters that a run found, as a gene file.
pub(crate) const GENES: &str = "calibrated.toml";

/// Folder of the keys of workers that the run brings up itself.
pub(crate) const KEYS: &str = "keys";

/// Longest list of settings that is written out in the name of a folder.
const LONGEST_SET: usize = 60;

/// What every manifest says, whatever kind of run it is of.
#[derive(Debug, Deserialize)]
pub(crate) struct Head {
    format: u32,
    program: String,
    #[serde(default = "calibrate")]
    pub(crate) kind: String,
}

/// A run folder.
#[derive(Clone, Debug)]
pub(crate) struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// A folder, whatever is in it.
    pub(crate) fn new(path: &Path) -> Self {
        let path = path.to_owned();
        Self { path }
    }

    /// `runs/CASE-WHAT[-SET...][-RECORDS-HASH]-seedN` below the current folder, so that the same command
    /// finds it. `set` is what distinguishes its settings; `measured` is the folder of records that replace the case's: many folders have the
    /// same name, so the start of the records' hash tells them apart.
    pub(crate) fn default_path(
        case: &Case,
        what: &str,
        set: &[String],
        measured: Option<&Path>,
        seed: u64,
    ) -> anyhow::Result<PathBuf> {
        let plain = |text: &str| -> String {
            let one = |c: char| match c {
                '.' => '.',
                c if c.is_ascii_alphanumeric() => c.to_ascii_lowercase(),
                _ => '-',
            };
            text.chars().map(one).collect()
        };
        let word = plain(&case.name).replace('.', "-");
        let words = set.iter().flat_map(|one| ["-".to_owned(), plain(one)]);
        let mut set: String = words.collect();
        if set.len() > LONGEST_SET {
            let hash = content_hash(&set)?.to_string();
            set = format!("-set-{}", hash.get(..8).unwrap_or_default());
        }
        let mut records = String::new();
        if let Some(folder) = measured {
            if let Some(name) = folder.file_name() {
                records = format!("-{}", name.to_string_lossy());
            }
            let hash = content_hash(&(&case.model, &case.conditions))?.to_string();
            records.extend(["-", hash.get(..8).unwrap_or_default()]);
        }
        Ok(Path::new("runs").join(format!("{word}-{what}{set}{records}-seed{seed}")))
    }

    /// The folder of a run of any kind.
    ///
    /// # Errors
    /// If no run was begun there.
    pub(crate) fn at(path: &Path) -> Result<Self, Problem> {
        let folder = Self::new(path);
        if folder.is_begun() {
            return Ok(folder);
        }
        Err(Problem {
            message: format!("{} is no run folder: it has no {MANIFEST}", path.display()),
            remedy:
                "`horsehead calibrate CASE` and `horsehead diagnose CASE` make them below runs/"
                    .to_owned(),
        })
    }

    /// What its manifest says, whatever kind of run it is of; an error if this version does not
    /// read it.
    pub(crate) fn head(&self) -> anyhow::Result<Head> {
        let head: Head = self.read_json(MANIFEST)?;
        if head.format == FORMAT {
            return Ok(head);
        }
        Err(Problem {
            message: format!(
                "{} was made by {}, in a form this version does not read",
                self.path.display(),
                head.program
            ),
            remedy: "use that version, or begin a new run with --run".to_owned(),
        }
        .into())
    }

    /// Refuses what is no folder, or is one with files of something else.
    pub(crate) fn check_vacant(&self) -> Result<(), Problem> {
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

    /// Whether a run was begun in it.
    pub(crate) fn is_begun(&self) -> bool {
        self.file(MANIFEST).exists()
    }

    /// Whether the run came to its end.
    pub(crate) fn is_finished(&self) -> bool {
        self.file(RESULT).exists()
    }

    /// Whether a journal with anything in it is there.
    pub(crate) fn has_journal(&self) -> bool {
        fs::metadata(self.file(journal::FILE)).is_ok_and(|file| file.len() > 0)
    }

    /// The journal, for reading alone; what of it is damaged goes to standard error.
    pub(crate) fn recording(&self) -> anyhow::Result<Recording> {
        let recording = Recording::read(&self.file(journal::FILE), |_, _| {})?;
        for damage in journal::words(&recording.report().damage) {
            terminal::tell(&format!("warning: {damage}"));
        }
        Ok(recording)
    }

    /// The folder.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A file in it.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file as JSON.
    pub(crate) fn write_json(&self, name: &str, value: &impl Serialize) -> anyhow::Result<()> {
        let mut text = serde_json::to_string_pretty(value)?;
        text.push('\n');
        self.write(name, &text)
    }

    /// Writes values of a case's unknowns, with a line that says where they come from.
    pub(crate) fn write_genes(
        &self,
        case: &Case,
        genes: &[f64],
        about: &str,
    ) -> anyhow::Result<()> {
        self.write(GENES, &write_genes(case, genes, about))?;
        if let Some((name, text)) = case::kind::of(case).gene_file(case, genes) {
            self.write(name, &text)?;
        }
        Ok(())
    }

    /// Writes a file as a whole: whoever reads it finds the old one or the new one.
    pub(crate) fn write(&self, name: &str, text: &str) -> anyhow::Result<()> {
        let file = self.file(name);
        let written = atomic_file::replace(&file, text.as_bytes());
        written.with_context(|| format!("cannot write {}", file.display()))
    }

    /// Reads a file of JSON.
    pub(crate) fn read_json<T: DeserializeOwned>(&self, name: &str) -> anyhow::Result<T> {
        let file = self.file(name);
        let damaged = |why: &dyn std::fmt::Display| Problem {
            message: format!("{} is damaged: {why}", file.display()),
            remedy: self.repair(),
        };
        let text = fs::read_to_string(&file).map_err(|error| damaged(&error))?;
        Ok(serde_json::from_str(&text).map_err(|error| damaged(&error))?)
    }

    /// How to go on where the manifest or the case is damaged: the journal knows which command the
    /// run belongs to.
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
