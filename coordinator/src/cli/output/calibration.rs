//! Output of a finished calibration: files in the run folder, and text or JSON on standard output.
use super::{
    object::{
        calibration::{CalibrateOutput, RivalOutput},
        score::{ConditionOutput, RecommendedAndOptimised, condition, unknowns},
    },
    terminal,
};
use crate::cli::{
    argument::output::Output,
    run::{
        calibration::{Calibration as Run, recorded},
        folder::{GENES, RESULT},
        tables,
    },
};
use case::CaseEffect;
use discrepancy::identify::UnknownEstimate;
use journal::account::JobCost;
use protocol::{
    case::WeightedCondition,
    job::{Counters, Evaluation, Verdict},
};
use report::{self, Calibration, ConditionResult, HistoryPoint, Individual, RivalFit};
use search::strategy::{
    Finish,
    family::{Rival, rivals},
};
use std::collections::BTreeMap;
use study::{
    self, Calibrated, CalibrationResult, Compared, ComparedCurves, LogEntry, RecordedCalibration,
};

/// Converts the comparison of the recommended and the optimised individual under one condition to the
/// report's type; `None` unless exactly these two were compared.
pub(crate) fn condition_result(compared: &Compared) -> Option<ConditionResult> {
    let [recommended, optimised] = compared.individuals.as_slice() else {
        return None;
    };
    Some(ConditionResult {
        condition: compared.condition,
        recommended: report_run(recommended),
        optimised: report_run(optimised),
    })
}

pub(crate) fn report_run(curves: &ComparedCurves) -> report::Run {
    let unscored = || Evaluation {
        verdict: curves.drawn.verdict,
        fitness: f64::NAN,
        channels: Vec::new(),
        residual: Vec::new(),
        columns: Vec::new(),
        counters: Counters::default(),
    };
    report::Run {
        evaluation: curves.evaluation.clone().unwrap_or_else(unscored),
        curves: curves.drawn.clone(),
    }
}

/// Reads the result of a finished calibration from its run folder, writes its files and prints it.
///
/// # Errors
/// As [`recorded`], and if a file cannot be written.
pub(crate) fn show(run: &Run, wall_s: f64, output: Output) -> anyhow::Result<()> {
    let recorded = recorded(run)?;
    terminal::damage(&recorded.account.damage);
    let calibration = calibration(run, &recorded, wall_s)?;
    let found = &recorded.result;
    let folder = &run.folder;
    let about = format!(
        "Calibrated parameters of {}: preset {}, seed {}, log {}",
        run.case.name, run.manifest.preset, run.manifest.seed, calibration.origin.digest
    );
    let effects = CaseEffect::all_of(&run.case);
    folder.write_genes(&run.case, &found.calibrated.best.genes, &effects, &about)?;
    let mut files = report::write_calibration(folder.path(), &calibration)?;
    files.extend(tables::calibration(run)?);
    files.extend([GENES, RESULT].map(|name| folder.file(name)));
    let files = files.iter().map(|path| path.display().to_string());
    let mut object = result_object(run, found, wall_s, files.collect());
    object
        .unknowns
        .add_identifiability(report::words::intervals(&calibration));
    object.machine = report::checks(&calibration);
    let rivals = calibration.rivals.iter();
    object.rivals = rivals
        .map(|rival| RivalOutput::new(&run.case, rival))
        .collect();
    folder.write_json(RESULT, &object)?;
    terminal::tell(&format!(
        "open {}\nparameters in {}",
        folder.file("report.html").display(),
        folder.file(GENES).display()
    ));
    let said = [
        report::rivals(&calibration),
        report::structure(&calibration),
    ];
    let flags = report::flags(&object.machine);
    for note in flags.into_iter().chain(said.into_iter().flatten()) {
        terminal::tell(&format!("note: {note}"));
    }
    let tables = || report::parameters(&calibration, terminal::style());
    terminal::print(output, tables, &object)
}

fn result_object<'a>(
    run: &'a Run,
    found: &CalibrationResult,
    wall_s: f64,
    files: Vec<String>,
) -> CalibrateOutput<'a> {
    let case = &run.case;
    let log = &found.calibrated.log;
    let mut calibrated = ConditionOutput {
        objective: RecommendedAndOptimised {
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
        let scores = condition(case, recommended, optimised);
        if compared.condition == case.objective.condition {
            calibrated = scores;
        } else {
            other_conditions.insert(case.conditions[compared.condition].name.clone(), scores);
        }
    }
    if !case.objective.others.is_empty() {
        calibrated.objective = total_objective(run, found);
    }
    CalibrateOutput {
        run: run.folder.path().display().to_string(),
        case: &case.name,
        preset: &run.manifest.preset,
        seed: run.manifest.seed,
        evaluations: log.len(),
        failed_simulations: log.failed(),
        wall_s,
        unknowns: unknowns(case, &found.calibrated.best.genes),
        objective: calibrated.objective,
        rivals: Vec::new(),
        channels: calibrated.channels,
        other_conditions,
        machine: Vec::new(),
        log_digest: log.digest(),
        files,
    }
}

/// Sums the objective of each parameter set (recommended, optimised) over the calibrated conditions with their
/// weights; null if
/// the simulation of a condition failed.
fn total_objective(run: &Run, found: &CalibrationResult) -> RecommendedAndOptimised<Option<f64>> {
    let objective = &run.case.objective;
    let of = |which: usize| -> Option<f64> {
        let fitness = |one: WeightedCondition| {
            let mut compared = found.compared.iter();
            let own = compared.find(|own| own.condition == one.condition)?;
            let evaluation = own.individuals.get(which)?.evaluation.as_ref()?;
            (evaluation.verdict == Verdict::Complete).then_some(one.weight * evaluation.fitness)
        };
        objective.weighted_conditions().map(fitness).sum()
    };
    RecommendedAndOptimised {
        recommended: of(0),
        optimised: of(1),
    }
}

/// Builds the data of a finished calibration's report.
pub(crate) fn calibration(
    run: &Run,
    recorded: &RecordedCalibration,
    wall_s: f64,
) -> anyhow::Result<Calibration> {
    let case = &run.case;
    let RecordedCalibration {
        result: found,
        estimates: identifiability,
        account,
        costs,
    } = recorded;
    let Calibrated {
        best, finish, log, ..
    } = &found.calibrated;
    let mut notes = [&run.manifest.notes[..], &found.notes].concat();
    if !best.complete {
        notes.push("no individual completed its simulation".to_owned());
    }
    let history = log
        .entries()
        .map(|entry| history_point(entry, costs.get(&entry.id).copied()));
    Ok(Calibration {
        case: case.clone(),
        origin: run.origin(log.digest())?,
        recommended: Individual {
            id: None,
            genes: case.start(),
        },
        optimised: Individual {
            id: Some(best.id),
            genes: best.genes.clone(),
        },
        history: history.collect(),
        workers: account.workers.clone(),
        presence: account.presence.clone(),
        spent: account.spent,
        wall_s,
        finish: match finish {
            Finish::Planned => "everything that was planned has been evaluated".to_owned(),
            Finish::Threshold => "the fitness threshold was reached".to_owned(),
        },
        conditions: found.compared.iter().filter_map(condition_result).collect(),
        rivals: rival_fits(run, &found.calibrated, identifiability)?,
        identifiability: identifiability.clone(),
        notes,
    })
}

/// Returns the best fits of other families whose objective lies near that of the best individual.
fn rival_fits(
    run: &Run,
    found: &Calibrated,
    identifiability: &[UnknownEstimate],
) -> anyhow::Result<Vec<RivalFit>> {
    let space = run.manifest.space(&run.case)?;
    let determined = |name: &str| report::is_determined(identifiability, name);
    let best = (&found.best.genes[..], found.best.fitness);
    let rivals = rivals(&space, best, &found.descent_ends, determined).into_iter();
    let fit = |rival: Rival<'_>| RivalFit {
        genes: rival.end.genes.clone(),
        objective: rival.end.fitness,
        differs: rival.differs.into_iter().map(str::to_owned).collect(),
    };
    Ok(rivals.map(fit).collect())
}

/// Converts a log entry to the report's type; `cost` is that of its simulation, if known.
pub(crate) fn history_point(entry: &LogEntry, cost: Option<JobCost>) -> HistoryPoint {
    HistoryPoint {
        id: entry.id,
        generation: entry.generation,
        purpose: entry.purpose.as_str().to_owned(),
        genes: entry.genes.clone(),
        fitness: entry.fitness,
        complete: entry.ending == study::EvaluationOutcome::Complete,
        failure: entry.ending.failure(),
        cost,
    }
}
