//! `horsehead export`: a run as tables for queries, from its journal.
use super::{
    EXIT_CODES, OutputChoice, bus,
    diagnosed::Earlier,
    finish, interrupt, output,
    problem::Usage,
    run_folder::{CALIBRATE, DIAGNOSE, Manifest, RunFolder},
};
use crate::{
    journal,
    store::{Exported, Format, Label, Store, StoreError, Target},
    study::{Crew, EvaluatorError, Observe, ProgressView, Recorded, Stop, StudyError, Watch},
};
use clap::{Args, ValueEnum};
use discrepancy::laboratory::Stage;
use protocol::{case::Case, event::Finished, job::Job};
use search::strategy::{Proposal, Settings};
use serde::Serialize;
use std::{cell::RefCell, collections::BTreeMap, path::PathBuf};

/// Turn a run into tables: a SQLite database, or a folder of CSV or Parquet files.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead export runs/cyjs10-5-37hb-quick-seed1
  horsehead export runs/cyjs10-5-37hb-quick-seed1 --format parquet --to tables

Works while the run goes on, and with a damaged journal, as far as that goes; the journal is not
changed. The table `dictionary` says what every column means.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration or diagnosis.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
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
    let object = export(arguments)?;
    for note in &object.notes {
        output::tell(&format!("note: {note}"));
    }
    output::print(arguments.output.output, || text(&object), &object)
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
    let manifest: Manifest<serde_json::Value> = folder.read_json("run.json")?;
    let case: Case = folder.read_json("case.json")?;
    let run = (&folder, &case, facts(&manifest)?);
    let (exported, notes) = if manifest.kind == DIAGNOSE {
        make(run, target, async |recorded, labels, stop| {
            let earlier = Earlier::open(path)?;
            let loaded = earlier.loaded()?;
            let mut labels = Labels(labels);
            let repeated = earlier.repeat(recorded, &loaded, &mut labels, stop);
            repeated.await.map(drop)
        })?
    } else {
        make(run, target, async |recorded, labels, stop| {
            let (_, manifest, case) = RunFolder::open::<Settings>(path, CALIBRATE)?;
            search_again(recorded, (&case, &manifest), labels, stop).await
        })?
    };
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

/// The tables of a calibration as CSV files of its folder; their paths.
pub(super) fn calibration(
    folder: &RunFolder,
    manifest: &Manifest,
    case: &Case,
) -> anyhow::Result<Vec<PathBuf>> {
    let format = Format::Csv;
    let target = Target {
        path: folder.file(format.usual_name()),
        format,
        force: true,
    };
    let run = (folder, case, facts(manifest)?);
    let (exported, notes) = make(run, target, async |recorded, labels, stop| {
        search_again(recorded, (case, manifest), labels, stop).await
    })?;
    for note in &notes {
        output::tell(&format!("note: {note}"));
    }
    Ok(exported.files)
}

async fn search_again(
    recorded: &mut Recorded<'_>,
    run: (&Case, &Manifest),
    labels: &Waiting,
    stop: &mut Stop,
) -> anyhow::Result<()> {
    finish::repeat(recorded, run, &mut Labels(labels), stop)
        .await
        .map(drop)
}

fn text(object: &ExportOutput) -> String {
    let rows = object.rows.iter();
    let rows = rows.map(|(table, rows)| format!("{rows:>9}  {table}\n"));
    let files = object.files.iter().map(|file| format!("{file}\n"));
    rows.chain(files).collect()
}

/// What is known of the run as a whole, beside its journal.
fn facts<S: Serialize>(manifest: &Manifest<S>) -> anyhow::Result<Vec<(&'static str, String)>> {
    let Manifest {
        kind,
        format: _,
        program,
        command,
        preset,
        seed,
        settings,
        start,
        case_folder,
        measured,
        synthetic,
        notes,
        wall_s,
    } = manifest;
    let start = start.as_ref().map_or_else(
        || "recommended".to_owned(),
        |start| start.file.display().to_string(),
    );
    Ok(vec![
        ("kind", kind.clone()),
        ("program", program.clone()),
        ("exported_by", bus::PROGRAM.to_owned()),
        ("command", command.clone()),
        ("preset", preset.clone()),
        ("seed", seed.to_string()),
        ("settings", serde_json::to_string(settings)?),
        ("start", start),
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

/// Labels of the simulations that were asked for and have not come back.
type Waiting = RefCell<BTreeMap<u64, Label>>;

/// Notes down why the study wants what it asks for.
struct Labels<'a>(&'a Waiting);

impl Observe for Labels<'_> {
    fn progress(&mut self, _: &ProgressView, _: &dyn Fn() -> Crew) {}

    fn asked(&mut self, proposal: &Proposal) {
        let label = Label {
            generation: Some(proposal.generation),
            purpose: proposal.purpose.as_str().to_owned(),
        };
        self.0.borrow_mut().insert(proposal.id, label);
    }
}

impl Watch for Labels<'_> {
    fn progress(&mut self, _: Stage, _: u64, _: usize, _: &dyn Fn() -> Crew) {}

    fn asked(&mut self, stage: Stage, id: u64) {
        let label = Label {
            generation: None,
            purpose: stage.name().to_owned(),
        };
        self.0.borrow_mut().insert(id, label);
    }
}

/// What is asked for outside the search: both parameter sets of the tables.
fn comparison() -> Label {
    Label {
        generation: None,
        purpose: "comparison".to_owned(),
    }
}

/// Reads the journal of a run, has its study repeated on it, and writes; what is missing in words.
fn make(
    (folder, case, facts): (&RunFolder, &Case, Vec<(&'static str, String)>),
    target: Target,
    repeat: impl AsyncFnOnce(&mut Recorded<'_>, &Waiting, &mut Stop) -> anyhow::Result<()>,
) -> anyhow::Result<(Exported, Vec<String>)> {
    let path = folder.file(journal::FILE);
    if !path.exists() {
        return Err(Usage {
            message: format!("{} has no journal yet", folder.path().display()),
            help: "the command that began the run makes it".to_owned(),
        }
        .into());
    }
    let mut store = Store::begin(target, case).map_err(explained)?;
    store.fact("case", &case.name)?;
    store.fact("case_hash", &bus::case_hash(case)?)?;
    for (name, value) in &facts {
        store.fact(name, value)?;
    }
    let recording = store.journal(&path)?;
    let mut notes = journal::words(&recording.report().damage);
    let (waiting, mut failed) = (Waiting::default(), None);
    let mut seen = |job: &Job, finished: &Finished| {
        let label = waiting.borrow_mut().remove(&finished.job().0);
        let added = store.evaluation(label.unwrap_or_else(comparison), job, finished);
        added.map_err(|error| {
            let message = error.to_string();
            failed = Some(error);
            EvaluatorError {
                message,
                help: None,
            }
        })
    };
    let mut recorded = Recorded::new(&recording, &mut seen);
    let repeated = bus::block_on(async {
        let mut stop = interrupt::listen();
        repeat(&mut recorded, &waiting, &mut stop).await
    });
    let (ended, unknown) = (recorded.ended(), recorded.unknown());
    if let Some(error) = failed {
        return Err(error.into());
    }
    if let Err(error) = repeated {
        if matches!(error.downcast_ref(), Some(StudyError::Interrupted)) {
            return Err(error);
        }
        notes.push(if ended {
            format!(
                "{unknown} of the simulations that the run has asked for so far have no result \
                     in the journal"
            )
        } else {
            format!(
                "the table evaluations ends where the run could not be repeated on its \
                     journal, the table results does not: {error:#}"
            )
        });
    }
    store.fact("missing", &notes.join("\n"))?;
    Ok((store.finish()?, notes))
}

/// Says what to do where something else is in the way.
fn explained(error: StoreError) -> anyhow::Error {
    let help = match &error {
        StoreError::Foreign { .. } => "choose another place with --to, or replace it with --force",
        StoreError::Io { .. } => "choose a place that can be written, with --to",
        StoreError::Table { .. } | StoreError::Journal(_) => return error.into(),
    };
    Usage {
        message: error.to_string(),
        help: help.to_owned(),
    }
    .into()
}

#[cfg(test)]
#[path = "export_tests.rs"]
mod tests;
