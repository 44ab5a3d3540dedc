//! Output of a finished calibration: files in the run folder, and text or JSON on standard output.
use super::{
    object::{
        calibration::{CalibrateOutput, RivalOutput},
        score::{ConditionOutput, RecommendedAndOptimised, condition, unknowns},
    },
    terminal,
};
use crate::cli::argument::output::Output;
use case::CaseEffect;
use protocol::{case::WeightedCondition, job::Verdict};
use run::{
    calibration::{CalibrationRun as Run, recorded, report_data},
    folder::{GENES, RESULT},
    message, tables,
};
use std::collections::BTreeMap;
use study::CalibrationResult;

/// Reads the result of a finished calibration from its run folder, writes its files and prints it.
///
/// # Errors
/// As [`recorded`], and if a file cannot be written.
pub(crate) fn show(run: &Run, wall_s: f64, output: Output) -> anyhow::Result<()> {
    let recorded = recorded(run)?;
    message::print_damage(&recorded.account.damage);
    let calibration = report_data(run, &recorded, wall_s)?;
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
    message::print(&format!(
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
        message::print(&format!("note: {note}"));
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
