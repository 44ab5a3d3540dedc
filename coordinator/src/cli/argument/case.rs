//! Arguments that name a case folder and its measured records, and loading of that case.
use case::{Overrides, load_with_notes};
use clap::Args;
use protocol::case::Case;
use record::Record;
use run::{manifest::StartPoint, message};
use std::{
    convert::Infallible,
    path::{Path, PathBuf},
};

/// Parses a case folder; the path of its `case.toml` is also accepted.
#[expect(clippy::unnecessary_wraps, reason = "the shape that clap asks for")]
pub(crate) fn case_folder(typed: &str) -> Result<PathBuf, Infallible> {
    let path = PathBuf::from(typed);
    let is_file = path.file_name().is_some_and(|name| name == "case.toml") && path.is_file();
    Ok(match path.parent().filter(|_| is_file) {
        Some(folder) if folder.as_os_str().is_empty() => PathBuf::from("."),
        Some(folder) => folder.to_owned(),
        None => path,
    })
}

/// Source of a case, shared by commands that read one.
#[derive(Clone, Debug, Args)]
pub(crate) struct CaseChoice {
    /// Case folder, with `case.toml` in it.
    #[arg(value_name = "CASE", value_parser = case_folder)]
    pub(crate) case: PathBuf,
    /// Folder whose inputs and records replace those of the case: a new test of the
    /// same machine.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    pub(crate) measured: Option<PathBuf>,
}

/// Loaded case, with the folder from which its measured records were read.
pub(crate) struct LoadedCase {
    pub(crate) case: Case,
    pub(crate) measured: String,
    /// Whether the case declares its records as computed (synthetic).
    pub(crate) synthetic: bool,
    pub(crate) notes: Vec<String>,
    /// Records with each cycle separate.
    pub(crate) cycles: Vec<Record>,
}

impl CaseChoice {
    /// Reads the case that the arguments name; prints notes on its records to standard error.
    pub(crate) fn load(&self) -> anyhow::Result<LoadedCase> {
        load_case(&self.case, self.measured.as_deref())
    }

    /// Reads the case that the arguments name, and the gene file to start at if one is given; the case takes the
    /// effects of the gene file. Prints notes on both to standard error.
    pub(crate) fn load_at(
        &self,
        genes: Option<&Path>,
    ) -> anyhow::Result<(LoadedCase, Option<StartPoint>)> {
        load_case_at(&self.case, self.measured.as_deref(), genes)
    }
}

/// Reads a case folder, with the measured records of another folder in place of its own if one is given;
/// prints notes on the records to standard error.
pub(crate) fn load_case(folder: &Path, measured: Option<&Path>) -> anyhow::Result<LoadedCase> {
    load_case_at(folder, measured, None).map(|(case, _)| case)
}

/// Reads a case folder as [`load_case`], and a gene file whose effects the case takes.
pub(crate) fn load_case_at(
    folder: &Path,
    measured: Option<&Path>,
    genes: Option<&Path>,
) -> anyhow::Result<(LoadedCase, Option<StartPoint>)> {
    let overrides = Overrides {
        measured: measured.map(Path::to_owned),
    };
    let mut loaded = load_with_notes(folder, &overrides)?;
    let start = genes.map(|file| StartPoint::read(file, &mut loaded));
    let start = start.transpose()?;
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    message::print_notes(&notes);
    let measured = measured.unwrap_or(folder).display().to_string();
    let case = LoadedCase {
        case: loaded.case,
        measured,
        synthetic: loaded.synthetic,
        notes,
        cycles: loaded.cycles,
    };
    Ok((case, start))
}
