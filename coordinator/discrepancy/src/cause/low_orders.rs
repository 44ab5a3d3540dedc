//! The likeliest effects by the low orders of the period alone.
//!
//! Where modes ring, tens of times a period, a wrong phase leaves more than any effect, and the fit that
//! leaves least may be one that has thrown the modes out: tests there say nothing. Far below them the
//! simulated thing follows its load without ringing. So where no refit has found a valley, a fit of
//! the low orders is tested instead, and the likeliest effects go from there with the size that they have.
use crate::cause::{refit, signature, suspect};
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, closest};
use crate::model::unknowns::Point;
use crate::record::whitened::WhitenedRecord;
use protocol::announce::EffectDescriptor;
use search::least_squares::Settings;

/// Highest order: half of what the lowest mode of a machine that rings usually has.
const HIGHEST: usize = 30;
/// Suspects that are refitted.
const REFITS: usize = 6;
/// Refits that are handed on.
const LIKELIEST: usize = 2;

/// Models with one more effect, the likeliest first, fitted to the low orders of the record; none where
/// they cannot be fitted, or some channel has no period. `current` is the model so far; its unknowns start
/// from the case's values, too. No order above `highest` is compared.
///
/// # Errors
/// Those of the laboratory.
pub async fn likeliest<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    current: &Fit,
    effects: &[EffectDescriptor],
    highest: usize,
) -> Result<Vec<Point>, L::Error> {
    let whole = experiments.on;
    if !whole.metric.is_periodic() {
        return Ok(Vec::new());
    }
    let highest = HIGHEST.min(highest);
    let low =
        WhitenedRecord::under_own_noise(whole.record.clone(), highest, whole.numerics.clone());
    let mut experiments = experiments.with(&low);
    let mut recommended = current.point();
    recommended.x[..current.model.space.dimension()].fill(0.0);
    let starts = vec![recommended, current.point()];
    let Some(fit) = closest(experiments.fits(starts, Settings::short(8)).await?) else {
        return Ok(Vec::new());
    };
    let mut tests = experiments.during(Stage::What);
    let suspects = signature::examine(&mut tests, &fit, effects).await?;
    let mut order = suspect::ranked(&suspects);
    order.truncate(REFITS);
    let mut refits = refit::refit(&mut experiments, &fit, &order).await?;
    refits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let likeliest = refits.iter().take(LIKELIEST);
    Ok(likeliest.map(|refit| refit.fit.point()).collect())
}
