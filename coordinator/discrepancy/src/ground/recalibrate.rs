//! Recalibration: fit of all unknowns, in the metric of the tests, to convergence.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::Settings;

/// Fits from several starts: a few iterations from each, then to convergence from the best.
///
/// # Errors
/// Those of the laboratory.
pub async fn from_starts<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    starts: Vec<Point>,
) -> Result<Option<Fit>, L::Error> {
    let fits = experiments.fits(starts, Settings::short(4)).await?;
    let cost = |a: &Fit, b: &Fit| a.search.cost().total_cmp(&b.search.cost());
    match fits.into_iter().flatten().min_by(cost) {
        Some(fit) => converge(experiments, fit.point()).await,
        None => Ok(None),
    }
}

/// Fits to convergence, with central differences.
///
/// # Errors
/// Those of the laboratory.
pub async fn converge<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    start: Point,
) -> Result<Option<Fit>, L::Error> {
    let settings = Settings {
        iterations: 10,
        decrease: 3e-4,
        central: true,
        ..Settings::default()
    };
    experiments.fit(start, settings).await
}
