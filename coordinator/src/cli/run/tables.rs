//! Export of a run as tables for queries: its study is repeated from its journal, and every simulation that
//! the study asks for becomes a row.
use super::{
    bus,
    calibration::{Calibration, calibrate},
    folder::RunFolder,
    interrupt,
    manifest::Manifest,
};
use crate::cli::output::{problem::Problem, terminal};
use discrepancy::laboratory::Stage;
use dispatch::journal;
use protocol::{case::Case, event::Finished, job::Job};
use search::strategy::Proposal;
use serde::Serialize;
use std::{cell::RefCell, collections::BTreeMap, path::PathBuf};
use store::{ColumnLabel, Exported, Format, Store, StoreError, Target};
use study::{
    EvaluatorError, ProgressView, ReplayEvaluator, StageView, Stop, StudyError, Watch,
    WorkersSnapshot,
};

/// Returns the properties of a run from its manifest, as names and values for the exported tables.
pub(crate) fn run_properties<S: Serialize>(
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
    let table = table.as_ref().map_or_else(String::new, |table| {
        let count = table.individuals.len();
        format!("{} ({count} individuals)", table.file.display())
    });
    Ok(vec![
        ("kind", kind.clone()),
        ("program", program.clone()),
        ("exported_by", bus::PROGRAM.to_owned()),
        ("command", command.clone()),
        ("preset", preset.clone()),
        ("set", set.join(" ")),
        ("seed", seed.to_string()),
        ("settings", serde_json::to_string(settings)?),
        ("start", start),
        ("individuals", table),
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

/// Labels (purpose and generation) of simulations that were requested and whose results are awaited, by job
/// number.
type Waiting = RefCell<BTreeMap<u64, ColumnLabel>>;

/// Observer of a study that records the purpose and generation of each requested simulation.
pub(crate) struct Labels<'a>(&'a Waiting);

impl Watch<ProgressView> for Labels<'_> {
    fn progress(&mut self, _: &ProgressView, _: &dyn Fn() -> WorkersSnapshot) {}

    fn asked(&mut self, id: u64, proposal: &Proposal) {
        let label = ColumnLabel {
            generation: Some(proposal.generation),
            purpose: proposal.purpose.as_str().to_owned(),
        };
        self.0.borrow_mut().insert(id, label);
    }
}

impl Watch<StageView> for Labels<'_> {
    fn progress(&mut self, _: &StageView, _: &dyn Fn() -> WorkersSnapshot) {}

    fn asked(&mut self, id: u64, stage: &Stage) {
        let label = ColumnLabel {
            generation: None,
            purpose: stage.name().to_owned(),
        };
        self.0.borrow_mut().insert(id, label);
    }
}

/// Returns the label of simulations requested outside the search, which are the two parameter sets that the
/// result tables compare.
fn comparison() -> ColumnLabel {
    ColumnLabel {
        generation: None,
        purpose: "comparison".to_owned(),
    }
}

/// Run whose tables are exported.
pub(crate) struct Source<'a> {
    pub(crate) folder: &'a RunFolder,
    pub(crate) case: &'a Case,
    /// Properties of the whole run, from [`run_properties`].
    pub(crate) facts: Vec<(&'static str, String)>,
}

/// Writes the tables of a calibration as CSV files into its run folder and returns their paths.
///
/// # Errors
/// As [`export`].
pub(crate) fn calibration(run: &Calibration) -> anyhow::Result<Vec<PathBuf>> {
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
    let (exported, notes) = export(&source, target, async |recorded, labels, stop| {
        calibrate(recorded, run, labels, stop).await.map(drop)
    })?;
    terminal::note(&notes);
    Ok(exported.files)
}

/// Reads the journal of a run, repeats its study with the recorded results, and writes the tables; also
/// returns notes on missing results.
///
/// # Errors
/// If there is no journal, the target cannot be written, or the user stops.
pub(crate) fn export(
    source: &Source<'_>,
    target: Target,
    repeat: impl AsyncFnOnce(&mut ReplayEvaluator<'_>, &mut Labels<'_>, &mut Stop) -> anyhow::Result<()>,
) -> anyhow::Result<(Exported, Vec<String>)> {
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
    store.fact("case_hash", &bus::case_hash(source.case)?)?;
    for (name, value) in &source.facts {
        store.fact(name, value)?;
    }
    let recording = store.journal(&path)?;
    let mut notes = journal::describe_damage(&recording.report().damage);
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
    let mut recorded = ReplayEvaluator::new(&recording, &mut seen);
    let repeated = bus::block_on(async {
        let mut stop = interrupt::listen();
        repeat(&mut recorded, &mut Labels(&waiting), &mut stop).await
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
                "the run could not be replayed completely from its journal: the table `evaluations` is \
                 incomplete, the table `results` is complete: {error:#}"
            )
        });
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
