//! `horsehead case`: checks a case folder, writes a template, or imports a PEST control file.
use crate::cli::{
    argument::{case::CaseChoice, output::OutputChoice},
    output::{problem::EXIT_CODES, terminal},
};
use case::command::{self, EntryProposal};
use case::{CaseError, Overrides, effect::check_known, load_with_notes, source::document};
use clap::{Args, Subcommand};
use run::{message, session::temporary::with_temporary_run};
use serde::Serialize;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};
use study::{self, StudyError};
use support::{Problem, atomic_file};

/// Check a case folder, or begin a new one.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Read a case with all its files, and report its content or its errors.
    #[command(after_help = format!("Example:\n  horsehead case check cases/cyjs10-5-37hb\n\n{EXIT_CODES}"))]
    Check {
        #[command(flatten)]
        choice: CaseChoice,
        #[command(flatten)]
        output: OutputChoice,
    },
    /// Write a commented template of `case.toml`, and of the data sheet of its record, into a new folder.
    #[command(after_help = format!("Example:\n  horsehead case new my-unit\n\n{EXIT_CODES}"))]
    New {
        /// Folder to make.
        folder: PathBuf,
    },
    /// Make a case of a model that is calibrated with PEST: parameters, observations, weights, templates and
    /// instructions as its control file says.
    #[command(after_help = format!("\
Examples:
  horsehead case import decay/model.pst
  horsehead case import model.pst my-case

The case is a folder of its own; all that lies in the control file's folder is copied into it and
travels with it. Parameters keep bounds, transformations, ties, scales and difference steps,
observations their weights; those of weight 0 become predictions, prior information is measured
like everything else. The objective is PEST's, and `calibrate --preset descent` goes down it as
PEST does. What has no meaning here is listed.

{EXIT_CODES}"))]
    Import {
        /// Control file of PEST.
        control: PathBuf,
        /// Folder to make [default: the control file's name, beside it].
        folder: Option<PathBuf>,
        #[command(flatten)]
        output: OutputChoice,
    },
}

/// JSON object printed by `case check --output json`.
#[derive(Debug, Serialize)]
struct CheckOutput<'a> {
    case: &'a str,
    conditions: &'a [String],
    #[serde(flatten)]
    unknowns: BTreeMap<&'static str, &'a [String]>,
    notes: Vec<String>,
}

/// Runs the selected action: check, new or import.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::Check { choice, output } => check(choice, *output),
        Action::New { folder } => write_template(folder),
        Action::Import {
            control,
            folder,
            output,
        } => import(control, folder.as_deref(), *output),
    }
}

fn check(choice: &CaseChoice, output: OutputChoice) -> anyhow::Result<()> {
    let overrides = Overrides {
        measured: choice.measured.clone(),
    };
    let summary = case::check(&choice.case, &overrides)?;
    let said = ask_worker(&choice.case, &overrides)?;
    let notes = summary.notes.iter().map(ToString::to_string);
    let object = CheckOutput {
        case: &summary.name,
        conditions: &summary.conditions,
        unknowns: BTreeMap::from([(summary.key, &summary.unknowns[..])]),
        notes: notes.chain(said.iter().cloned()).collect(),
    };
    let text = || {
        let said = said.iter().map(|note| format!("\nnote: {note}"));
        summary.text.trim_end().to_owned() + &said.collect::<String>()
    };
    terminal::print(output.output, text, &object)
}

/// Asks a local worker whether it knows the case's effects and whether the measured records fit the channels;
/// returns its notes.
fn ask_worker(folder: &Path, overrides: &Overrides) -> anyhow::Result<Vec<String>> {
    let loaded = load_with_notes(folder, overrides)?;
    let case = &loaded.case;
    if case::kind::of(case).is_program() {
        let note = "not simulated: `horsehead simulate CASE` starts the case's program once";
        return Ok(vec![note.to_owned()]);
    }
    let asked = || -> anyhow::Result<Vec<String>> {
        if !loaded.effects.is_empty() {
            // an effect that no worker knows leaves no case to work on
            let mut bare = case.clone();
            bare.effects.clear();
            bare.effect_units.clear();
            bare.unknowns
                .retain(|unknown| unknown.of_effect().is_none());
            let library = with_temporary_run(&bare, "check", 1, async |dispatch, stop| {
                study::library(dispatch, stop).await
            })?;
            let document = document(folder, overrides)?;
            check_known(&document, &loaded.effects, &library)?;
        }
        with_temporary_run(case, "check", 1, async |dispatch, stop| {
            study::check_records(dispatch, case, &loaded.cycles, stop).await
        })
    };
    asked().or_else(|error| match error.downcast_ref::<StudyError>() {
        Some(StudyError::Misconfigured { field, .. }) if field == "model.kind" => {
            Ok(vec![format!(
                "not simulated: the workers of this machine do not simulate `{}`",
                case.model.kind
            )])
        }
        Some(_) => Err(error),
        None if error.is::<CaseError>() => Err(error),
        None => Ok(vec![format!("not simulated: {error}")]),
    })
}

/// JSON object printed by `case import --output json`.
#[derive(Debug, Serialize)]
struct ImportOutput {
    case: String,
    /// Number of estimated parameters.
    parameters: usize,
    /// Number of observations with nonzero weight.
    observations: usize,
    /// Entries of the control file that were changed or omitted in the import.
    notes: Vec<String>,
}

fn import(control: &Path, folder: Option<&Path>, output: OutputChoice) -> anyhow::Result<()> {
    let imported = command::import::import(control, folder).map_err(|error| Problem {
        message: error.to_string(),
        remedy: "nothing was written".to_owned(),
    })?;
    let [parameters, observations] = imported.counts;
    let mut object = ImportOutput {
        case: imported.folder.display().to_string(),
        parameters,
        observations,
        notes: imported.notes.clone(),
    };
    message::print_notes(&object.notes);
    // what was written is read as every command will read it; a folder that none can read would block the next try
    let read = |folder: &Path| -> anyhow::Result<EntryProposal> {
        case::check(folder, &Overrides::default())?;
        Ok(command::propose_entry(folder)?)
    };
    let proposal = read(&imported.folder).map_err(|error| {
        drop(std::fs::remove_dir_all(&imported.folder));
        message::print(&format!(
            "note: no case was made, and {} was removed again: correct the files beside {}, then import it again",
            imported.folder.display(),
            control.display()
        ));
        // the copies are gone, and the files beside the control file are those to be corrected
        let beside = control.parent().unwrap_or(Path::new(""));
        let copied = format!("{}/", imported.folder.display());
        let own = match beside.to_str() {
            Some("") | None => String::new(),
            Some(folder) => format!("{folder}/"),
        };
        let text = error.to_string();
        let text = text.replace(&format!("{copied}case.toml"), &control.display().to_string());
        let text = text.replace(&copied, &own);
        let (message, remedy) = text.split_once("\nhelp: ").unwrap_or((&text, ""));
        Problem {
            message: message.to_owned(),
            remedy: remedy.to_owned(),
        }
    })?;
    if !proposal.is_there {
        let note = format!(
            "this machine has no program `{}`: install it here, or run `horsehead allow` on the machines that have it",
            proposal.entry.program.display()
        );
        message::print_notes(std::slice::from_ref(&note));
        object.notes.push(note);
    }
    let EntryProposal { name, entry, .. } = proposal;
    let entry = exchange::allow::Allowed {
        entry: [(name, entry)].into(),
    };
    let words = || {
        let case = &object.case;
        format!(
            "wrote {case}: {parameters} parameters, {observations} observations\n\n\
             Machines that work on it must allow this entry; on this one\n  horsehead allow {case}\n\
             writes it:\n\n{}\nThen\n  horsehead calibrate {case} --preset descent\n",
            exchange::allow::text(&entry)
        )
    };
    terminal::print(output.output, words, &object)
}

fn write_template(folder: &Path) -> anyhow::Result<()> {
    let files = case::pumping_unit::new_files()?;
    let places = files.iter().map(|(name, _)| folder.join(name));
    if let Some(there) = places.clone().find(|file| file.exists()) {
        return Err(Problem {
            message: format!("{} exists already", there.display()),
            remedy: "choose another folder; nothing was written".to_owned(),
        }
        .into());
    }
    for (file, (_, text)) in places.zip(&files) {
        let parent = file.parent().unwrap_or(folder);
        let written = std::fs::create_dir_all(parent)
            .and_then(|()| atomic_file::replace(&file, text.as_bytes()));
        written.map_err(|error| Problem {
            message: format!("cannot write {}: {error}", file.display()),
            remedy: "choose a folder that can be written".to_owned(),
        })?;
        message::print(&format!("wrote {}", file.display()));
    }
    message::print(&format!(
        "put the files it names beside it, then run `horsehead case check {}`",
        folder.display()
    ));
    Ok(())
}
