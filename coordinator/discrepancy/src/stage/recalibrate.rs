//! Recalibration: all genes, in the metric of the tests, until the gradient vanishes.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
use search::least_squares::Settings;

/// A fit from the best of several starts: a few steps of each, then on with the best.
///
/// # Errors
/// Of the laboratory.
pub async fn from_starts<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    model: &Model,
    starts: Vec<Vec<f64>>,
) -> Result<Option<Fit>, L::Error> {
    let first = Settings {
        iterations: 4,
        ..Settings::default()
    };
    let starts = starts.into_iter().map(|x| (model.clone(), x)).collect();
    let fits = bench.fit(lab, Stage::Recalibrate, starts, first).await?;
    let best = fits
        .into_iter()
        .flatten()
        .min_by(|a, b| a.search.cost().total_cmp(&b.search.cost()));
    match best {
        Some(fit) => converge(lab, bench, model, fit.x()).await,
        None => Ok(None),
    }
}

/// A fit to convergence, with central differences.
///
/// # Errors
/// Of the laboratory.
pub async fn converge<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    model: &Model,
    x: &[f64],
) -> Result<Option<Fit>, L::Error> {
    let settings = Settings {
        iterations: 10,
        decrease: 3e-4,
        central: true,
        ..Settings::default()
    };
    let fits = bench
        .fit(
            lab,
            Stage::Recalibrate,
            vec![(model.clone(), x.to_vec())],
            settings,
        )
        .await?;
    Ok(fits.into_iter().next().flatten())
}
