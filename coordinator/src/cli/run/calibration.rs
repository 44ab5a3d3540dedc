//! Work of a calibration, and its result as the journal states it.
use super::{diagnosis::inputs, opened::Run};
use discrepancy::{diagnose::Inputs, identify::LinearEstimate, thresholds::Thresholds};
use protocol::case::Case;
use search::strategy::{self, Settings};
use study::{
    self, CalibrationResult, Evaluator, ProgressView, RecordedCalibration, StageView, Stop,
    StudyError, Watch,
};

/// Calibration: run of `horsehead calibrate`.
pub(crate) type Calibration = Run<Settings>;

/// Runs the calibration, with the given evaluator for all simulations.
///
/// # Errors
/// As [`study::calibrate_case`].
pub(crate) async fn calibrate<E: Evaluator>(
    evaluator: &mut E,
    run: &Calibration,
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
pub(crate) fn recorded(run: &Calibration) -> anyhow::Result<RecordedCalibration> {
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
pub(crate) async fn identifiability<E: Evaluator>(
    evaluator: &mut E,
    run: &Calibration,
    best: &[f64],
    watch: &mut impl Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<Option<LinearEstimate>> {
    // the cycles of the records are in the case folder alone
    let Ok(loaded) = run.loaded() else {
        return Ok(None);
    };
    let nothing = (Vec::new(), "");
    let inputs = inputs(&loaded, &run.manifest, &Thresholds::default(), nothing)?;
    let inputs = Inputs {
        start: Some(inputs.space.point(best)),
        ..inputs
    };
    Ok(study::estimate_at_start_on(evaluator, &inputs, watch, stop).await?)
}

/// Returns the parameter sets compared in the result tables, recommended and optimised, with their names.
pub(crate) fn pair(case: &Case, best: &[f64]) -> Vec<(String, Vec<f64>)> {
    vec![
        ("recommended".to_owned(), case.start()),
        ("optimised".to_owned(), best.to_vec()),
    ]
}
