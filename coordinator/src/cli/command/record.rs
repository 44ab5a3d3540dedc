//! `horsehead record`: import of gauge records and load cards from raw files.
use crate::cli::{
    argument::{case::case_folder, output::OutputChoice},
    output::{problem::EXIT_CODES, terminal},
};
use anyhow::Context as _;
use case::pumping_unit::import::{ImportKind, ImportTarget, MappingProposal, kind_of};
use clap::{Args, Subcommand};
use report::pumping_unit::{imported_card, turns};
use run::message;
use serde::Serialize;
use std::path::{Path, PathBuf};
use support::{Problem, atomic_file::Draft};

/// Import gauge records and load cards from the files of loggers and dynamometers.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Make a record and a load card of the case from raw files, by a mapping that is proposed.
    #[command(after_help = format!("\
Examples:
  horsehead record import strain.csv --case my-unit --condition 5rpm
  horsehead record import well.dyn --case my-unit --condition 5rpm
  horsehead record import --case my-unit --condition 5rpm

The first command reads the file, proposes which of its columns are what, and writes the proposal
beside the record, as `NAME.import.toml`. What only a person knows is listed: state it there, then
repeat the command. Once nothing is missing it writes the record or card that the case names, its
data sheet, and a picture of all turns over each other. Raw files are never changed.

{EXIT_CODES}"))]
    Import {
        /// Files of a logger in the order of time, or of a dynamometer; without any, the imports of the
        /// condition are repeated.
        files: Vec<PathBuf>,
        /// Case folder, with `case.toml` in it.
        #[arg(long, value_name = "CASE", value_parser = case_folder, env = "HORSEHEAD_CASE")]
        case: PathBuf,
        /// Condition that was recorded; needed if the case has several.
        #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
        condition: Option<String>,
        #[command(flatten)]
        output: OutputChoice,
    },
}

/// JSON object printed by `record import --output json`.
#[derive(Debug, Serialize)]
struct ImportOutput {
    condition: String,
    imports: Vec<Imported>,
}

/// One record or card that was imported.
#[derive(Debug, Serialize)]
struct Imported {
    kind: &'static str,
    /// Files that were written.
    files: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordFigures>,
    notes: Vec<String>,
}

/// Figures of an imported record.
#[derive(Debug, Serialize)]
struct RecordFigures {
    samples: usize,
    turns: usize,
    speed_rpm: f64,
    rate_hz: f64,
}

/// Runs `record import`.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let Action::Import {
        files,
        case,
        condition,
        output,
    } = &arguments.action;
    let target = ImportTarget::new(case, condition.as_deref())?;
    let groups = groups(&target, files)?;
    let mut ready = Vec::new();
    let mut open = Vec::new();
    for (kind, files) in groups {
        match prepare(&target, kind, &files)? {
            None => ready.push(kind),
            Some(question) => open.push(question),
        }
    }
    if !open.is_empty() {
        return Err(Problem {
            message: open.join("\n"),
            remedy: "state these keys in the mapping, check the others, then repeat the command; nothing else \
                     was written"
                .to_owned(),
        }
        .into());
    }
    // everything is read before anything is written
    let prepared = ready.into_iter().map(|kind| match kind {
        ImportKind::Record => import_record(&target),
        ImportKind::Card => import_card(&target),
    });
    let prepared = prepared.collect::<anyhow::Result<Vec<_>>>()?;
    publish(
        &prepared
            .iter()
            .flat_map(|(_, files)| files)
            .collect::<Vec<_>>(),
    )?;
    let object = ImportOutput {
        condition: target.name().to_owned(),
        imports: prepared.into_iter().map(|(imported, _)| imported).collect(),
    };
    for imported in &object.imports {
        message::print_notes(&imported.notes);
    }
    let text = || {
        let lines = object.imports.iter().map(|imported| {
            let files = imported.files.iter().map(|file| format!("wrote {file}\n"));
            let figures = imported.record.as_ref().map(|record| {
                format!(
                    "{} samples, {} whole turns at {:.3} /min, {:.2} Hz\n",
                    record.samples, record.turns, record.speed_rpm, record.rate_hz
                )
            });
            figures.unwrap_or_default() + &files.collect::<String>()
        });
        let lines: String = lines.collect();
        format!(
            "{lines}look at the pictures, then run `horsehead case check {}`",
            case.display()
        )
    };
    terminal::print(output.output, text, &object)
}

/// Returns the raw files of each record and card to import; without files the imports that have a mapping.
fn groups(
    target: &ImportTarget,
    files: &[PathBuf],
) -> anyhow::Result<Vec<(ImportKind, Vec<PathBuf>)>> {
    let mut groups: Vec<(ImportKind, Vec<PathBuf>)> = Vec::new();
    for file in files {
        let kind = kind_of(file)?;
        match groups.iter_mut().find(|(own, _)| *own == kind) {
            Some((_, group)) => group.push(file.clone()),
            None => groups.push((kind, vec![file.clone()])),
        }
    }
    if files.is_empty() {
        for kind in [ImportKind::Card, ImportKind::Record] {
            if target.mapping(kind).is_ok_and(|path| path.exists()) {
                groups.push((kind, Vec::new()));
            }
        }
    }
    if groups.is_empty() {
        return Err(Problem {
            message: format!("condition `{}` has no import to repeat", target.name()),
            remedy: "name the raw files to import".to_owned(),
        }
        .into());
    }
    Ok(groups)
}

/// Prepares the mapping of an import: writes a proposal where there is none. Returns what must be stated
/// first, or `None` if the import can go on.
fn prepare(
    target: &ImportTarget,
    kind: ImportKind,
    files: &[PathBuf],
) -> anyhow::Result<Option<String>> {
    let path = target.mapping(kind)?;
    if path.exists() {
        target.check_files(kind, files)?;
        return Ok(None);
    }
    let MappingProposal { text, open } = target.propose(kind, files)?;
    publish(&[&(path.clone(), text.clone().into_bytes())])?;
    message::print(&format!("proposed {}:\n\n{text}", path.display()));
    Ok((!open.is_empty()).then(|| {
        let open = open.iter().map(|key| format!("\n  {key}"));
        format!("{} lacks{}", path.display(), open.collect::<String>())
    }))
}

/// Path and content of each file that an import writes.
type Files = Vec<(PathBuf, Vec<u8>)>;

fn import_record(target: &ImportTarget) -> anyhow::Result<(Imported, Files)> {
    let record = target.import_record()?;
    let figure = turns(&record.turn_deg, &record.channels, &record.cycles);
    let picture = target.mapping(ImportKind::Record)?.with_extension("svg");
    let mut files = record.files;
    files.push((picture, figure.svg.into_bytes()));
    let figures = RecordFigures {
        samples: record.samples,
        turns: record.turns,
        speed_rpm: record.speed_rpm,
        rate_hz: record.rate_hz,
    };
    let imported = Imported {
        kind: "record",
        files: names(&files),
        record: Some(figures),
        notes: record.notes,
    };
    Ok((imported, files))
}

fn import_card(target: &ImportTarget) -> anyhow::Result<(Imported, Files)> {
    let card = target.import_card()?;
    let figure = imported_card(
        &card.turn_deg,
        &card.load_n,
        &card.position_m,
        &card.expected_m,
    );
    let picture = target.mapping(ImportKind::Card)?.with_extension("svg");
    let files = vec![
        (target.output(ImportKind::Card)?, card.csv.into_bytes()),
        (picture, figure.svg.into_bytes()),
    ];
    let imported = Imported {
        kind: "card",
        files: names(&files),
        record: None,
        notes: card.notes,
    };
    Ok((imported, files))
}

fn names(files: &Files) -> Vec<String> {
    files
        .iter()
        .map(|(path, _)| path.display().to_string())
        .collect()
}

/// Writes files, with the folders that they are in: all are complete before any replaces what was there.
fn publish(files: &[&(PathBuf, Vec<u8>)]) -> anyhow::Result<()> {
    let cannot = |path: &Path| format!("cannot write {}", path.display());
    let mut drafts = Vec::new();
    for (path, content) in files {
        let folder = path.parent().unwrap_or_else(|| Path::new("."));
        let draft = std::fs::create_dir_all(folder).and_then(|()| Draft::new(path, content));
        drafts.push((draft.with_context(|| cannot(path))?, path));
    }
    for (draft, path) in drafts {
        draft.publish().with_context(|| cannot(path))?;
    }
    Ok(())
}
