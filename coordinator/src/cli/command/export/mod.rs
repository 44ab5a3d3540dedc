//! `horsehead export`: exports a run from its journal as tables for queries, or the folders of its failed
//! simulations.
mod failed;

use crate::cli::{
    argument::output::OutputChoice,
    output::{problem::EXIT_CODES, terminal},
};
use clap::{Args, ValueEnum};
use protocol::case::Case;
use run::{
    folder::{CASE, MANIFEST, RunFolder},
    manifest::Manifest,
    message,
    tables::{self, Source},
};
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

Works for every kind of run but scaling, while it goes on, and with a damaged journal as far as
that goes; the journal is not changed. The table `dictionary` says what every column means.

With --failed, what somebody's own program left where it failed: a folder for each individual,
with what was filled in, what the program wrote and said, and `why.txt`. Of long files the end
travels; a worker sends the folders of the first failures of every slot.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    /// Fetch the files that failed runs of an external program left, instead of tables [default folder:
    /// failed in RUN].
    #[arg(long, conflicts_with = "format", env = "HORSEHEAD_FAILED")]
    failed: bool,
    /// Format of the tables.
    #[arg(long, value_enum, default_value = "sqlite", env = "HORSEHEAD_FORMAT")]
    format: Form,
    /// File, or folder for CSV and Parquet [default: run.sqlite, csv or parquet in RUN].
    #[arg(long, value_name = "PATH", env = "HORSEHEAD_TO")]
    to: Option<PathBuf>,
    /// Replace existing files even if they are no export: the file, or the files of the same names.
    #[arg(long, env = "HORSEHEAD_FORCE")]
    force: bool,
    #[command(flatten)]
    output: OutputChoice,
}

/// Export formats as named on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// One SQLite database.
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

/// JSON object printed by `export --output json`.
#[derive(Debug, Serialize)]
struct ExportOutput {
    run: String,
    /// Format of the exported tables.
    format: &'static str,
    files: Vec<String>,
    /// Number of rows of each exported table.
    rows: BTreeMap<&'static str, u64>,
    /// Whether the results of all simulations that the run requested are exported.
    complete: bool,
    /// Notes on data that are missing from the export, each with the reason.
    notes: Vec<String>,
}

/// Exports the chosen run and prints a summary.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.failed {
        let to = arguments.to.as_deref();
        let object = failed::fetch(&arguments.run, to, arguments.force)?;
        message::print_notes(&object.notes);
        let text = || failed::text(&object);
        return terminal::print(arguments.output.output, text, &object);
    }
    let object = export(arguments)?;
    message::print_notes(&object.notes);
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
        facts: tables::run_properties(&manifest)?,
    };
    let (exported, notes) = tables::export(&source, target)?;
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
