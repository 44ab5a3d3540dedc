//! Output of results: tables or one JSON object on standard output, files in a folder, progress on standard
//! error.
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use comfy_table::{CellAlignment, LineStyle, Table, presets};
use serde::Serialize;
use std::fs;
use std::io::{self, Write as _};
use std::path::PathBuf;

/// Format of printed results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// A table for people.
    Table,
    /// One JSON object for programs.
    Json,
}

/// Options for the output of results.
#[derive(Clone, Debug, Args)]
pub(crate) struct Output {
    /// Folder for output files; without it none are written.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Format of printed results.
    #[arg(long, value_enum, default_value = "table")]
    output: Form,
}

impl Output {
    /// Prints a result as a table or as JSON.
    pub(crate) fn print(
        &self,
        table: &impl ToString,
        object: &impl Serialize,
    ) -> anyhow::Result<()> {
        let text = match self.output {
            Form::Table => table.to_string(),
            Form::Json => serde_json::to_string(object)?,
        };
        Ok(writeln!(io::stdout().lock(), "{text}")?)
    }

    /// Writes a file into the output folder, if one is given.
    pub(crate) fn write(
        &self,
        name: &str,
        content: impl FnOnce() -> anyhow::Result<Vec<u8>>,
    ) -> anyhow::Result<()> {
        let Some(folder) = &self.out else {
            return Ok(());
        };
        let path = folder.join(name);
        let content = content()?;
        fs::create_dir_all(folder)
            .and_then(|()| fs::write(&path, content))
            .with_context(|| format!("cannot write {}", path.display()))?;
        self.print_progress(&format!("wrote {}", path.display()))
    }

    /// Prints a progress line to standard error, except with JSON output.
    pub(crate) fn print_progress(&self, line: &str) -> anyhow::Result<()> {
        match self.output {
            Form::Table => Ok(writeln!(io::stderr().lock(), "{line}")?),
            Form::Json => Ok(()),
        }
    }
}

/// Creates a table with the given header; all columns but the first are right-aligned.
pub(crate) fn table(head: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    table.set_header(head);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
