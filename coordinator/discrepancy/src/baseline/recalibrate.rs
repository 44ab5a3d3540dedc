//! Recalibration: fit of all unknowns, in the metric of the tests, to convergence.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::LeastSquaresSettings;

/// Fits all unknowns from several starts: a few iterations from each, then to convergence from the best.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn from_starts<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    starts: Vec<Point>,
) -> Result<Option<Fit>, L::Error> {
    let fits = experiments
        .fits(starts, LeastSquaresSettings::short(4))
        .await?;
    let cost = |a: &Fit, b: &Fit| a.search.cost().total_cmp(&b.search.cost());
    match fits.into_iter().flatten().min_by(cost) {
        Some(fit) => converge(experiments, fit.point()).await,
        None => Ok(None),
    }
}

/// Fits all unknowns from one start to convergence, with central differences.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn converge<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    start: Point,
) -> Result<Option<Fit>, L::Error> {
    let settings = LeastSquaresSettings {
        iterations: 10,
        decrease: 3e-4,
        central: true,
        ..LeastSquaresSettings::default()
    };
    experiments.fit(start, settings).await
}
