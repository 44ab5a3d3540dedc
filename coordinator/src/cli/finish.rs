//! From a run folder to its result: the search (or its repetition), the comparison, the files.
use super::{
    Door, Output, bus, export,
    json::{self, Both, CalibrateOutput},
    output,
    run_folder::{Manifest, RunFolder},
};
use crate::{
    account, journal,
    report::{
        self, Calibration, ConditionResult, HistoryPoint, Individual, Provenance, Run, WorkerUse,
        table,
    },
    study::{self, Calibrated, Compared, Curves, Evaluator, Observe, Stop, Wanted},
};
use protocol::{
    case::Case,
    event::WorkerAccount,
    job::{Counters, Evaluation},
};
use search::strategy::{Finish, Settings, Strategy};
use std::{collections::BTreeMap, time::Instant};

/// One session of a run.
pub(super) struct Session<'a> {
    pub(super) folder: &'a RunFolder,
    pub(super) manifest: &'a Manifest,
    pub(super) case: &'a Case,
    /// Wall time of earlier sessions (s).
    pub(super) earlier_s: f64,
    pub(super) started: Instant,
    pub(super) door: Door,
    /// Worker processes to start here.
    pub(super) local_workers: usize,
    /// Whether the run was begun by an earlier session.
    pub(super) resumed: bool,
}

/// What a session found.
pub(super) struct Found {
    pub(super) calibrated: Calibrated,
    /// The calibrated condition first.
    compared: Vec<Compared>,
}

impl Session<'_> {
    /// Wall time of all sessions (s).
    pub(super) fn wall_s(&self) -> f64 {
        self.earlier_s + self.started.elapsed().as_secs_f64()
    }

    /// Searches, then compares recommended and best individual under every recorded condition.
    /// What the journal holds is not computed again.
    pub(super) async fn run(
        &self,
        observer: &mut dyn Observe,
        stop: &mut Stop,
    ) -> anyhow::Result<Found> {
        let mut strategy = strategy(self.case, self.manifest)?;
        let options = bus::Options {
            run_dir: self.folder.path().to_owned(),
            door: self.door.clone(),
            local_workers: self.local_workers,
            kind: "calibrate".to_owned(),
            settings: self.manifest.settings_json()?,
        };
        let mut bus = bus::Bus::open(options, self.case).await?;
        self.begun(bus.recorded())?;
        observer.resumed(bus.recorded());
        let found = work(&mut bus, self.case, strategy.as_mut(), observer, stop).await;
        // while the run is still locked
        let remembered = self.folder.spent(self.manifest, self.case, self.wall_s());
        let closed = bus.close().await;
        let found = found?;
        remembered?;
        closed?;
        Ok(found)
    }

    /// Writes down how the run was begun, now that its journal is ours, and says so.
    fn begun(&self, recorded: usize) -> anyhow::Result<()> {
        let (folder, manifest) = (self.folder, self.manifest);
        folder.spent(manifest, self.case, self.earlier_s)?;
        let path = folder.path().display();
        output::tell(&match (self.resumed || recorded > 0, recorded) {
            (false, _) => format!("beginning {path}"),
            (true, 1) => format!("going on with {path}: its journal holds 1 result"),
            (true, _) => format!("going on with {path}: its journal holds {recorded} results"),
        });
        Ok(())
    }
}

/// The same search again, on what answers from a recording.
pub(super) async fn repeat<E: Evaluator>(
    evaluator: &mut E,
    (case, manifest): (&Case, &Manifest),
    observer: &mut dyn Observe,
    stop: &mut Stop,
) -> anyhow::Result<Found> {
    let mut strategy = strategy(case, manifest)?;
    Ok(work(evaluator, case, strategy.as_mut(), observer, stop).await?)
}

fn strategy(case: &Case, manifest: &Manifest) -> anyhow::Result<Box<dyn Strategy>> {
    let space = manifest.space(case)?;
    let settings: &Settings = &manifest.settings;
    let built = settings.build(&space, manifest.seed);
    Ok(built.map_err(study::StudyError::from)?)
}

async fn work<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    strategy: &mut dyn Strategy,
    observer: &mut dyn Observe,
    stop: &mut Stop,
) -> Result<Found, study::StudyError> {
    let calibrated = study::calibrate(evaluator, case, strategy, observer, stop).await?;
    debug_assert!(
        strategy.finished().is_some(),
        "a calibration ends with its search"
    );
    let wanted = comparison(case, &calibrated.best.genes);
    let compared = study::compare(evaluator, case, &wanted, stop).await?;
    Ok(Found {
        calibrated,
        compared,
    })
}

/// Recommended and best individual under every condition with a record, the calibrated one first
/// and with the moving machine.
fn comparison(case: &Case, best: &[f64]) -> Vec<Wanted> {
    let calibrated = case.objective.condition;
    let recorded = |index: &usize| case.conditions[*index].record.is_some();
    let others = (0..case.conditions.len())
        .filter(|index| *index != calibrated)
        .filter(recorded);
    std::iter::once(calibrated)
        .chain(others)
        .map(|condition| Wanted {
            condition,
            individuals: pair(case, best),
            motion_step_deg: if condition == calibrated { 3.0 } else { 0.0 },
        })
        .collect()
}

/// The two parameter sets of the paper's tables.
pub(super) fn pair(case: &Case, best: &[f64]) -> Vec<(String, Vec<f64>)> {
    vec![
        ("recommended".to_owned(), case.recommended()),
        ("optimised".to_owned(), best.to_vec()),
    ]
}

/// The report's form of one comparison of recommended and optimised.
pub(super) fn condition_result(compared: &Compared) -> Option<ConditionResult> {
    let [recommended, optimised] = compared.individuals.as_slice() else {
        return None;
    };
    Some(ConditionResult {
        condition: compared.condition,
        recommended: report_run(recommended),
        optimised: report_run(optimised),
    })
}

fn report_run(curves: &Curves) -> Run {
    let unscored = || Evaluation {
        verdict: curves.simulation.verdict,
        fitness: f64::NAN,
        channels: Vec::new(),
        residual_mpa: Vec::new(),
        counters: Counters::default(),
    };
    Run {
        evaluation: curves.evaluation.clone().unwrap_or_else(unscored),
        simulation: curves.simulation.clone(),
    }
}

/// Writes the files of a finished run and prints its result.
pub(super) fn show(session: &Session<'_>, found: &Found, output: Output) -> anyhow::Result<()> {
    let calibration = calibration(session, found)?;
    let folder = session.folder;
    let about = format!(
        "Calibrated parameters of {}: preset {}, seed {}, log {}",
        session.case.name,
        session.manifest.preset,
        session.manifest.seed,
        calibration.provenance.digest
    );
    let genes = crate::case::write_genes(session.case, &found.calibrated.best.genes, &about);
    folder.write("calibrated.toml", &genes)?;
    let mut files: Vec<String> = report::write_calibration(folder.path(), &calibration)?
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let exported = export::calibration(folder, session.manifest, session.case)?;
    files.extend(exported.iter().map(|path| path.display().to_string()));
    files.push(folder.file("calibrated.toml").display().to_string());
    files.push(folder.file("result.json").display().to_string());
    let object = result_object(session, found, files);
    folder.write_json("result.json", &object)?;
    output::tell(&format!(
        "open {}\nparameters in {}",
        folder.file("report.html").display(),
        folder.file("calibrated.toml").display()
    ));
    output::print(output, || tables(&calibration), &object)
}

fn tables(calibration: &Calibration) -> String {
    let styled = output::styled();
    let mut text = table::text(&table::table_3(calibration), styled);
    for result in &calibration.conditions {
        if result.condition != calibration.case.objective.condition {
            text.push('\n');
            text.push_str(&table::text(
                &table::table_4(&calibration.case, result),
                styled,
            ));
        }
    }
    text
}

fn result_object<'a>(
    session: &Session<'a>,
    found: &Found,
    files: Vec<String>,
) -> CalibrateOutput<'a> {
    let case = session.case;
    let log = &found.calibrated.log;
    let mut calibrated = json::ConditionOutput {
        objective: Both {
            recommended: None,
            optimised: None,
        },
        channels: BTreeMap::new(),
    };
    let mut other_conditions = BTreeMap::new();
    for compared in &found.compared {
        let [recommended, optimised] = compared.individuals.as_slice() else {
            continue;
        };
        let scores = json::condition(recommended, optimised);
        if compared.condition == case.objective.condition {
            calibrated = scores;
        } else {
            other_conditions.insert(case.conditions[compared.condition].name.clone(), scores);
        }
    }
    CalibrateOutput {
        run: session.folder.path().display().to_string(),
        case: &case.name,
        preset: &session.manifest.preset,
        seed: session.manifest.seed,
        evaluations: log.len(),
        failed_simulations: log.failed(),
        wall_s: session.wall_s(),
        genes: json::genes(case, &found.calibrated.best.genes),
        objective: calibrated.objective,
        channels: calibrated.channels,
        other_conditions,
        log_digest: log.digest(),
        files,
    }
}

fn calibration(session: &Session<'_>, found: &Found) -> anyhow::Result<Calibration> {
    let case = session.case;
    // what workers of earlier sessions did is in the journal alone
    let account = account::read(&session.folder.file(journal::FILE))?;
    let Calibrated { best, finish, log } = &found.calibrated;
    let mut notes = session.manifest.notes.clone();
    if !best.complete {
        notes.push("no individual completed its simulation".to_owned());
    }
    let history = log.entries().map(|entry| HistoryPoint {
        id: entry.id,
        generation: entry.generation,
        purpose: entry.purpose.as_str().to_owned(),
        genes: entry.genes.clone(),
        fitness: entry.fitness,
        complete: entry.ending == study::Ending::Complete,
        failure: entry.ending.failure(),
    });
    Ok(Calibration {
        case: case.clone(),
        provenance: Provenance {
            program: session.manifest.program.clone(),
            command: session.manifest.command.clone(),
            run: session.folder.path().display().to_string(),
            case_hash: bus::case_hash(case)?,
            measured_name: session.manifest.measured.clone(),
            preset: Some(session.manifest.preset.clone()),
            seed: Some(session.manifest.seed),
            digest: log.digest(),
            synthetic: session.manifest.synthetic,
        },
        recommended: Individual {
            id: None,
            genes: case.recommended(),
        },
        optimised: Individual {
            id: Some(best.id),
            genes: best.genes.clone(),
        },
        history: history.collect(),
        workers: account.workers.iter().map(worker_use).collect(),
        spent: account.spent,
        wall_s: session.wall_s(),
        finish: match finish {
            Finish::Planned => "everything that was planned has been evaluated".to_owned(),
            Finish::Threshold => "the fitness threshold was reached".to_owned(),
        },
        conditions: found.compared.iter().filter_map(condition_result).collect(),
        notes,
    })
}

fn worker_use(worker: &WorkerAccount) -> WorkerUse {
    let seconds = |us: u64| us as f64 / 1e6;
    WorkerUse {
        name: worker.worker.to_string(),
        host: worker.host.clone(),
        slots: worker.slots,
        done: worker.done,
        failed: worker.failed,
        busy_s: seconds(worker.spent.useful_us),
        present_s: seconds(worker.spent.connected_us) / f64::from(worker.slots.max(1)),
    }
}
