//! `horsehead case`: look at a case, or begin one.
use crate::cli::{
    argument::{case::CaseChoice, output::OutputChoice},
    output::{
        problem::{EXIT_CODES, Usage},
        terminal,
    },
};
use clap::{Args, Subcommand};
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Check a case folder, or begin a new one.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Read a case with all its files, and tell what is in it or what is wrong.
    #[command(after_help = format!("Example:\n  horsehead case check cases/cyjs10-5-37hb\n\n{EXIT_CODES}"))]
    Check {
        #[command(flatten)]
        choice: CaseChoice,
        #[command(flatten)]
        output: OutputChoice,
    },
    /// Write a commented template of `case.toml` into a new folder.
    #[command(after_help = format!("Example:\n  horsehead case new my-unit\n\n{EXIT_CODES}"))]
    New {
        /// Folder to make.
        folder: PathBuf,
    },
}

/// What `case check --output json` prints.
#[derive(Debug, Serialize)]
struct CheckOutput<'a> {
    case: &'a str,
    conditions: &'a [String],
    #[serde(flatten)]
    unknowns: BTreeMap<&'static str, &'a [String]>,
    notes: Vec<String>,
}

/// Checks or begins.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::Check { choice, output } => check(choice, *output),
        Action::New { folder } => begin(folder),
    }
}

fn check(choice: &CaseChoice, output: OutputChoice) -> anyhow::Result<()> {
    let overrides = crate::case::Overrides {
        measured: choice.measured.clone(),
    };
    let summary = crate::case::check(&choice.case, &overrides)?;
    let object = CheckOutput {
        case: &summary.name,
        conditions: &summary.conditions,
        unknowns: BTreeMap::from([(summary.key, &summary.unknowns[..])]),
        notes: summary.notes.iter().map(ToString::to_string).collect(),
    };
    terminal::print(output.output, || summary.text.clone(), &object)
}

fn begin(folder: &std::path::Path) -> anyhow::Result<()> {
    let file = folder.join("case.toml");
    if file.exists() {
        return Err(Usage {
            message: format!("{} exists already", file.display()),
            help: "choose another folder; nothing was written".to_owned(),
        }
        .into());
    }
    std::fs::create_dir_all(folder)?;
    std::fs::write(&file, crate::pumping_unit::case::template())?;
    terminal::tell(&format!(
        "wrote {}\nput the files it names beside it, then run `horsehead case check {}`",
        file.display(),
        folder.display()
    ));
    Ok(())
}
