//! The likeliest effects by the low orders of the crank alone.
//!
//! Where the rope's modes ring, sixty and eighty times a turn, a wrong phase leaves more than any effect,
//! and the fit that leaves least may be one that has thrown the modes out: tests there say nothing. Far
//! below them the machine follows its load without ringing. So where no refit has found a valley, a fit of
//! the low orders is tested instead, and the likeliest effects go from there with the size that they have.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage};
use crate::metric::Metric;
use crate::model::Model;
use crate::noise::Noise;
use crate::spectrum::Orders;
use crate::stage::{refit, suspect};
use protocol::announce::EffectDescriptor;
use search::least_squares::Settings;

/// Highest order: half of the lower mode's.
const HIGHEST: usize = 30;
/// Suspects that are refitted.
const REFITS: usize = 6;
/// Refits that are handed on.
const LIKELIEST: usize = 2;

/// Models with one more effect, the likeliest first, fitted to the low orders of the record; none where
/// they cannot be fitted. `current` is the model so far; its genes start from the recommended ones, too.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn likeliest<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    current: &Fit,
    effects: &[EffectDescriptor],
) -> Result<Vec<(Model, Vec<f64>)>, L::Error> {
    let low = low(bench);
    let genes = current.model.space.dimension();
    let recommended = vec![0.0; genes];
    let effects_as_they_are = current.x().iter().skip(genes).copied();
    let starts = [
        recommended.into_iter().chain(effects_as_they_are).collect(),
        current.x().to_vec(),
    ];
    let starts = starts
        .map(|x: Vec<f64>| (current.model.clone(), x))
        .to_vec();
    let how = Settings {
        iterations: 8,
        ..Settings::default()
    };
    let fits = low.fit(lab, Stage::Refit, starts, how).await?;
    let least = |a: &Fit, b: &Fit| a.chi_squared().total_cmp(&b.chi_squared());
    let Some(fit) = fits.into_iter().flatten().min_by(least) else {
        return Ok(Vec::new());
    };
    let suspects = suspect::examine(lab, &low, &fit, effects, 1.0).await?;
    let mut order: Vec<_> = suspects.iter().filter(|s| s.statistic() > 0.0).collect();
    order.sort_by(|a, b| {
        a.p_value()
            .total_cmp(&b.p_value())
            .then(b.statistic().total_cmp(&a.statistic()))
    });
    order.truncate(REFITS);
    let mut refits = refit::refit(lab, &low, &fit, &order).await?;
    refits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let likeliest = refits.into_iter().take(LIKELIEST);
    Ok(likeliest
        .map(|refit| {
            let x = refit.fit.x().to_vec();
            (refit.fit.model, x)
        })
        .collect())
}

/// The same record, its low orders alone.
fn low(bench: &Bench) -> Bench {
    let record = bench.record.clone();
    let highest = HIGHEST.min(bench.metric.orders().highest());
    let orders = Orders::new(record.samples(), highest);
    let noise = Noise::estimate(&record, &orders, &[]);
    let metric = Metric::new(orders, record.channels.len(), &noise.covariances);
    Bench::new(record, metric, bench.refinement)
}
