//! Work of a calibration: the search, then the comparison of the recommended with the best individual.
use super::{diagnosis::inputs, opened::Run};
use discrepancy::{diagnose::Inputs, identify::LinearEstimate, thresholds::Thresholds};
use protocol::case::Case;
use search::strategy::{self, Settings};
use study::{
    self, Calibrated, CompareRequest, Compared, Evaluator, PICTURES, ProgressView, StageView, Stop,
    StudyError, Watch,
};

/// Calibration: run of `horsehead calibrate`.
pub(crate) type Calibration = Run<Settings>;

/// Results of a calibration.
pub(crate) struct Found {
    /// Best individual and evaluation log of the calibration's search.
    pub(crate) calibrated: Calibrated,
    /// Comparisons of the recommended and the best individual, the calibrated condition first.
    pub(crate) compared: Vec<Compared>,
    /// Notes about records that do not fit their channels.
    pub(crate) notes: Vec<String>,
}

/// Simulates the recommended individual, runs the search, and compares the recommended with the best
/// individual. The evaluator is either the workers or the recording of a journal, which reproduces the
/// results.
///
/// # Errors
/// As [`study::calibrate()`] and [`study::compare()`].
pub(crate) async fn calibrate<E: Evaluator>(
    evaluator: &mut E,
    run: &Calibration,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<Found> {
    let (case, manifest) = (&run.case, &run.manifest);
    let space = manifest.space(case)?;
    let first = manifest.first_individuals().unwrap_or_default();
    let built = strategy::build_after(&manifest.settings, &space, manifest.seed, first);
    let mut strategy = built.map_err(StudyError::from)?;
    let wanted = study::recommended(case, PICTURES);
    // workers may be long in coming
    let mut view = ProgressView::default();
    view.plan(&strategy.progress());
    watch.progress(&view, &|| evaluator.workers_status());
    let recommended = match study::compare(evaluator, case, &wanted, stop).await {
        // others may do better; without a comparison there is no report
        Err(error @ StudyError::Unavailable { .. }) => Err(error),
        other => Ok(other?),
    };
    let notes = recommended
        .as_ref()
        .map(|all| study::mismatches(case, &[], all));
    let notes = notes.unwrap_or_default();
    watch.noted(&notes);
    let calibrated = study::calibrate(evaluator, case, strategy.as_mut(), watch, stop).await?;
    let recommended = recommended?;
    let best = |one: CompareRequest| CompareRequest {
        first: 1,
        individuals: vec![("optimised".to_owned(), calibrated.best.genes.clone())],
        ..one
    };
    let wanted: Vec<CompareRequest> = wanted.into_iter().map(best).collect();
    let optimised = study::compare(evaluator, case, &wanted, stop).await?;
    let both = recommended.into_iter().zip(optimised);
    let both = both.map(|(mut recommended, optimised)| {
        recommended.individuals.extend(optimised.individuals);
        recommended
    });
    Ok(Found {
        calibrated,
        compared: both.collect(),
        notes,
    })
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
