//! Work of a calibration, its result as the journal states it, and the data of its report.
use crate::{diagnosis::inputs_at, opened::Run};
use discrepancy::identify::{LinearEstimate, UnknownEstimate};
use journal::account::JobCost;
use protocol::{
    case::Case,
    job::{Counters, Evaluation},
};
use report::{ConditionResult, HistoryPoint, Individual, RivalFit};
use search::strategy::{
    self, Finish, Settings,
    family::{Rival, rivals},
};
use study::{
    self, Calibrated, CalibrationResult, Compared, ComparedCurves, Evaluator, LogEntry,
    NamedIndividual, ProgressView, RecordedCalibration, StageView, Stop, StudyError, Watch,
};

/// Run of `horsehead calibrate`.
pub type CalibrationRun = Run<Settings>;

/// Runs the calibration, with the given evaluator for all simulations.
///
/// # Errors
/// As [`study::calibrate_case`].
pub async fn calibrate<E: Evaluator>(
    evaluator: &mut E,
    run: &CalibrationRun,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<CalibrationResult> {
    let (case, manifest) = (&run.case, &run.manifest);
    let space = manifest.space(case)?;
    let first = manifest.first_individuals().unwrap_or_default();
    let built = strategy::build_after(&manifest.settings, &space, manifest.seed, first);
    let mut strategy = built.map_err(StudyError::from)?;
    Ok(study::calibrate_case(evaluator, case, strategy.as_mut(), watch, stop).await?)
}

/// Reads the result of a finished calibration from its journal.
///
/// # Errors
/// If the calibration is not finished, or its journal is missing, damaged or of another version.
pub fn recorded(run: &CalibrationRun) -> anyhow::Result<RecordedCalibration> {
    let read = run
        .expect_journal()
        .map(|path| study::read_calibration(&path, &run.case))?;
    read.map_err(|error| run.unreadable(error))
}

/// Estimates to first order how well the measured record determines the unknowns at the best individual, each
/// with an interval; `None` if the case has changed or no estimate is possible.
///
/// # Errors
/// If no evaluator is left, or the user stops the run.
pub async fn identifiability<E: Evaluator>(
    evaluator: &mut E,
    run: &CalibrationRun,
    best: &[f64],
    watch: &mut impl Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<Option<LinearEstimate>> {
    // the cycles of the records are in the case folder alone
    let Ok(loaded) = run.loaded() else {
        return Ok(None);
    };
    let inputs = inputs_at(&loaded, &run.manifest, best)?;
    Ok(study::estimate_at_start_on(evaluator, &inputs, watch, stop).await?)
}

/// Returns the parameter sets compared in the result tables, recommended and optimised, with their names.
pub fn pair(case: &Case, best: &[f64]) -> Vec<NamedIndividual> {
    vec![
        NamedIndividual::new("recommended", case.start()),
        NamedIndividual::new("optimised", best.to_vec()),
    ]
}

/// Converts the comparison of the recommended and the optimised individual under one condition to the
/// report's type; `None` unless exactly these two were compared.
pub fn condition_result(compared: &Compared) -> Option<ConditionResult> {
    let [recommended, optimised] = compared.individuals.as_slice() else {
        return None;
    };
    Some(ConditionResult {
        condition: compared.condition,
        recommended: scored_curves(recommended),
        optimised: scored_curves(optimised),
    })
}

/// Converts the curves of an individual, and its evaluation if it has one, to the report's type.
pub fn scored_curves(curves: &ComparedCurves) -> report::ScoredCurves {
    let unscored = || Evaluation {
        verdict: curves.drawn.verdict,
        fitness: f64::NAN,
        channels: Vec::new(),
        residual: Vec::new(),
        columns: Vec::new(),
        counters: Counters::default(),
    };
    report::ScoredCurves {
        evaluation: curves.evaluation.clone().unwrap_or_else(unscored),
        curves: curves.drawn.clone(),
    }
}

/// Builds the data of a finished calibration's report.
///
/// # Errors
/// If the case of the run cannot be encoded, or has no space to search.
pub fn report_data(
    run: &CalibrationRun,
    recorded: &RecordedCalibration,
    wall_s: f64,
) -> anyhow::Result<report::Calibration> {
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
    Ok(report::Calibration {
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
        assessments: run.folder.assessments()?,
        notes,
    })
}

/// Returns the best fits of other families whose objective lies near that of the best individual.
fn rival_fits(
    run: &CalibrationRun,
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
pub fn history_point(entry: &LogEntry, cost: Option<JobCost>) -> HistoryPoint {
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
