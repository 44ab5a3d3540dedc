//! `horsehead export`: a run as tables for queries, and the folders of its failed runs, from its journal.
mod failed;

use crate::cli::{
    argument::output::OutputChoice,
    output::{problem::EXIT_CODES, terminal},
    run::{
        folder::{CASE, MANIFEST, RunFolder},
        kind::AnyRun,
        manifest::Manifest,
        tables::{self, Source},
    },
};
use clap::{Args, ValueEnum};
use protocol::case::Case;
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};
use store::{Format, Target};

/// Turn a run into tables (a SQLite database, or a folder of CSV or Parquet files), or fetch failed runs.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead export runs/cyjs10-5-37hb-quick-seed1
  horsehead export runs/cyjs10-5-37hb-quick-seed1 --format parquet --to tables

  horsehead export runs/tank --failed

Works while the run goes on, and with a damaged journal, as far as that goes; the journal is not
changed. The table `dictionary` says what every column means.

With --failed, what somebody's own program left where it failed: a folder for each individual,
with what was filled in, what the program wrote and said, and `why.txt`. Of long files the end
travels; a worker sends the folders of the first failures of every slot.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration or diagnosis.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    /// Fetch what failed runs of somebody's own program left, in place of tables [default folder: failed in RUN].
    #[arg(long, conflicts_with = "format", env = "HORSEHEAD_FAILED")]
    failed: bool,
    /// In which form.
    #[arg(long, value_enum, default_value = "sqlite", env = "HORSEHEAD_FORMAT")]
    format: Form,
    /// File, or folder for CSV and Parquet [default: run.sqlite, csv or parquet in RUN].
    #[arg(long, value_name = "PATH", env = "HORSEHEAD_TO")]
    to: Option<PathBuf>,
    /// Replace what is there even if it is no export: the file, or the files of the same names.
    #[arg(long, env = "HORSEHEAD_FORCE")]
    force: bool,
    #[command(flatten)]
    output: OutputChoice,
}

/// The forms, as the command line names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// One database.
    Sqlite,
    /// One CSV file per table.
    Csv,
    /// One Parquet file per table.
    Parquet,
}

impl From<Form> for Format {
    fn from(form: Form) -> Self {
        match form {
            Form::Sqlite => Self::Sqlite,
            Form::Csv => Self::Csv,
            Form::Parquet => Self::Parquet,
        }
    }
}

/// What programs read.
#[derive(Debug, Serialize)]
struct ExportOutput {
    /// The run's folder.
    run: String,
    /// The form.
    format: &'static str,
    /// What was written.
    files: Vec<String>,
    /// Rows of each table.
    rows: BTreeMap<&'static str, u64>,
    /// Whether every simulation that the run asked for is there.
    complete: bool,
    /// What is missing, and why.
    notes: Vec<String>,
}

/// Exports and says what there is.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.failed {
        let to = arguments.to.as_deref();
        let object = failed::fetch(&arguments.run, to, arguments.force)?;
        terminal::note(&object.notes);
        let text = || failed::text(&object);
        return terminal::print(arguments.output.output, text, &object);
    }
    let object = export(arguments)?;
    terminal::note(&object.notes);
    terminal::print(arguments.output.output, || text(&object), &object)
}

fn export(arguments: &Arguments) -> anyhow::Result<ExportOutput> {
    let path = &arguments.run;
    let folder = RunFolder::at(path)?;
    let format = Format::from(arguments.format);
    let usual = || folder.file(format.usual_name());
    let target = Target {
        path: arguments.to.clone().unwrap_or_else(usual),
        format,
        force: arguments.force,
    };
    // a run of another version may have settings that this one cannot read: its results it can
    let manifest: Manifest<serde_json::Value> = folder.read_json(MANIFEST)?;
    let case: Case = folder.read_json(CASE)?;
    let source = Source {
        folder: &folder,
        case: &case,
        facts: tables::facts(&manifest)?,
    };
    let (exported, notes) = tables::make(&source, target, async |recorded, labels, stop| {
        let run = AnyRun::open(path)?;
        run.repeat(recorded, labels, stop).await.map(drop)
    })?;
    let files = exported.files.iter();
    Ok(ExportOutput {
        run: path.display().to_string(),
        format: format.as_str(),
        files: files.map(|file| file.display().to_string()).collect(),
        rows: exported.rows,
        complete: notes.is_empty(),
        notes,
    })
}

fn text(object: &ExportOutput) -> String {
    let rows = object.rows.iter();
    let rows = rows.map(|(table, rows)| format!("{rows:>9}  {table}\n"));
    let files = object.files.iter().map(|file| format!("{file}\n"));
    rows.chain(files).collect()
}

#[cfg(test)]
mod tests;
