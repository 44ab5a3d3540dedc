//! Command `horsehead record`: import of gauge records and load cards from raw files.
use crate::cli::{
    argument::{case::case_folder, output::OutputChoice},
    output::{
        problem::{EXIT_CODES, Problem},
        terminal,
    },
};
use anyhow::Context as _;
use case::pumping_unit::import::{ImportKind, ImportTarget, MappingProposal, kind_of};
use clap::{Args, Subcommand};
use report::pumping_unit::{imported_card, turns};
use serde::Serialize;
use std::path::{Path, PathBuf};
use support::atomic_file;

/// Import gauge records and load cards from the files of loggers and dynamometers.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
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
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let Action::Import {
        files,
        case,
        condition,
        output,
    } = &arguments.action;
    let target = ImportTarget::new(case, condition.as_deref())?;
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
    let imports = ready.into_iter().map(|kind| match kind {
        ImportKind::Record => import_record(&target),
        ImportKind::Card => import_card(&target),
    });
    let object = ImportOutput {
        condition: target.name().to_owned(),
        imports: imports.collect::<anyhow::Result<_>>()?,
    };
    for imported in &object.imports {
        terminal::note(&imported.notes);
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
    write(&path, text.as_bytes())?;
    terminal::tell(&format!("proposed {}:\n\n{text}", path.display()));
    Ok((!open.is_empty()).then(|| {
        let open = open.iter().map(|key| format!("\n  {key}"));
        format!("{} lacks{}", path.display(), open.collect::<String>())
    }))
}

fn import_record(target: &ImportTarget) -> anyhow::Result<Imported> {
    let record = target.import_record()?;
    let mut files = Vec::new();
    for (path, content) in &record.files {
        write(path, content)?;
        files.push(path.display().to_string());
    }
    let picture = target.mapping(ImportKind::Record)?.with_extension("svg");
    let figure = turns(&record.turn_deg, &record.channels, &record.cycles);
    write(&picture, figure.svg.as_bytes())?;
    files.push(picture.display().to_string());
    Ok(Imported {
        kind: "record",
        files,
        record: Some(RecordFigures {
            samples: record.samples,
            turns: record.turns,
            speed_rpm: record.speed_rpm,
            rate_hz: record.rate_hz,
        }),
        notes: record.notes,
    })
}

fn import_card(target: &ImportTarget) -> anyhow::Result<Imported> {
    let card = target.import_card()?;
    let path = target.output(ImportKind::Card)?;
    let picture = target.mapping(ImportKind::Card)?.with_extension("svg");
    let figure = imported_card(
        &card.turn_deg,
        &card.load_n,
        &card.position_m,
        &card.expected_m,
    );
    write(&path, card.csv.as_bytes())?;
    write(&picture, figure.svg.as_bytes())?;
    Ok(Imported {
        kind: "card",
        files: vec![path.display().to_string(), picture.display().to_string()],
        record: None,
        notes: card.notes,
    })
}

/// Writes a file in one step, with the folder that it is in.
fn write(path: &Path, content: &[u8]) -> anyhow::Result<()> {
    let folder = path.parent().unwrap_or_else(|| Path::new("."));
    std::fs::create_dir_all(folder)
        .and_then(|()| atomic_file::replace(path, content))
        .with_context(|| format!("cannot write {}", path.display()))
}
