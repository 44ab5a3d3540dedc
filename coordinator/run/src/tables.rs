//! Export of a run as tables for queries: a fold over its journal.
use crate::{
    calibration::CalibrationRun, folder::RunFolder, hash, manifest, manifest::Manifest, message,
};
use protocol::case::Case;
use serde::Serialize;
use std::path::PathBuf;
use store::{Contents, Exported, Format, Store, StoreError, Target};
use support::Problem;

/// Returns the properties of a run from its manifest, as names and values for the exported tables.
///
/// # Errors
/// If the settings cannot be encoded.
pub fn run_properties<S: Serialize>(
    manifest: &Manifest<S>,
) -> anyhow::Result<Vec<(&'static str, String)>> {
    let Manifest {
        kind,
        format: _,
        program,
        command,
        preset,
        set,
        seed,
        settings,
        start,
        table,
        assessed,
        case_folder,
        measured,
        synthetic,
        notes,
        effects: _,
        wall_s,
    } = manifest;
    let start = start.as_ref().map_or_else(
        || "recommended".to_owned(),
        |start| start.file.display().to_string(),
    );
    let table = table.as_ref().map_or_else(String::new, |table| {
        let count = table.individuals.len();
        format!("{} ({count} individuals)", table.file.display())
    });
    Ok(vec![
        ("kind", kind.clone()),
        ("program", program.clone()),
        ("exported_by", manifest::PROGRAM.to_owned()),
        ("command", command.clone()),
        ("preset", preset.clone()),
        ("set", set.join(" ")),
        ("seed", seed.to_string()),
        ("settings", serde_json::to_string(settings)?),
        ("start", start),
        ("individuals", table),
        (
            "assessed",
            assessed
                .as_ref()
                .map_or_else(String::new, |run| run.display().to_string()),
        ),
        ("case_folder", case_folder.display().to_string()),
        ("measured", measured.clone()),
        (
            "records",
            if *synthetic { "synthetic" } else { "measured" }.to_owned(),
        ),
        ("notes", notes.join("\n")),
        ("wall_s", wall_s.to_string()),
    ])
}

/// Run whose tables are exported.
pub struct Source<'a> {
    /// Folder of the run.
    pub folder: &'a RunFolder,
    /// Case of the run.
    pub case: &'a Case,
    /// Properties of the whole run, from [`run_properties`].
    pub facts: Vec<(&'static str, String)>,
}

/// Writes the tables of a calibration as CSV files into its run folder and returns their paths.
///
/// # Errors
/// As [`export`].
pub fn calibration(run: &CalibrationRun) -> anyhow::Result<Vec<PathBuf>> {
    let format = Format::Csv;
    let target = Target {
        path: run.folder.file(format.usual_name()),
        format,
        force: true,
    };
    let source = Source {
        folder: &run.folder,
        case: &run.case,
        facts: run_properties(&run.manifest)?,
    };
    let (exported, notes) = export(&source, target)?;
    message::print_notes(&notes);
    Ok(exported.files)
}

/// Reads the journal of a run and writes the tables; also returns notes on missing results.
///
/// # Errors
/// If there is no journal, or the target cannot be written.
pub fn export(source: &Source<'_>, target: Target) -> anyhow::Result<(Exported, Vec<String>)> {
    let path = source.folder.file(journal::FILE);
    if !path.exists() {
        return Err(Problem {
            message: format!("{} has no journal yet", source.folder.path().display()),
            remedy:
                "start the run again with the command that created it; the journal is written then"
                    .to_owned(),
        }
        .into());
    }
    let mut store = Store::begin(target, source.case).map_err(explained)?;
    store.fact("case", &source.case.name)?;
    store.fact("case_hash", &hash::case_hash(source.case)?)?;
    for (name, value) in &source.facts {
        store.fact(name, value)?;
    }
    let Contents {
        damage,
        unanswered,
        unknown,
    } = store.journal(&path)?;
    let mut notes = journal::describe_damage(&damage);
    if unanswered > 0 && !source.folder.is_finished() {
        notes.push(format!(
            "{unanswered} of the simulations that the run has asked for so far have no result in the journal"
        ));
    }
    if unknown > 0 {
        notes.push(format!(
            "the requests of {unknown} results cannot be read: these are in the table `results` and not in `evaluations`"
        ));
    }
    store.fact("missing", &notes.join("\n"))?;
    Ok((store.finish()?, notes))
}

/// Adds a remedy to an export error that is caused by the target file or folder.
fn explained(error: StoreError) -> anyhow::Error {
    let help = match &error {
        StoreError::Foreign { .. } => "choose another place with --to, or replace it with --force",
        StoreError::Io { .. } => "choose a writable file or folder with --to",
        StoreError::Table { .. } | StoreError::Journal(_) => return error.into(),
    };
    Problem {
        message: error.to_string(),
        remedy: help.to_owned(),
    }
    .into()
}
