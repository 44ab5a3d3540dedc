//! Search for the likeliest effects in the low orders of the period alone.
//!
//! Where modes ring, at tens of times the frequency of the period, a phase error leaves a larger residual
//! than any effect, and the best fit may be one that has suppressed the modes, so tests there are
//! meaningless. Far below the mode frequencies the simulated system follows its load quasi-statically. If no
//! refit has found the narrow minimum, a fit of the low orders is therefore tested instead, and the likeliest
//! effects start from that fit with their estimated sizes.
use crate::hypothesis::{candidate, refit, signature};
use crate::laboratory::{Laboratory, Stage};
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::{Fit, closest};
use crate::model::unknowns::Point;
use protocol::announce::EffectDescriptor;
use search::least_squares::LeastSquaresSettings;

/// Part of the orders of a record that counts as low, one in as many: a record that resolves a mode has orders
/// well above it.
const LOW: usize = 4;
/// Number of candidate effects that are refitted to the low orders.
const REFITS: usize = 6;
/// Number of refits to the low orders that are returned: the likeliest ones.
const LIKELIEST: usize = 2;

/// Returns the models with one more effect, fitted to the low orders of the record, likeliest first; empty
/// where no fit completes or some channel is not periodic. `current` is the model so far; fits start both
/// from its unknowns and from the recommended values of the case. The lowest quarter of the `highest`
/// compared orders counts as low.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
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
    let highest = highest.div_ceil(LOW);
    let low =
        WhitenedRecord::under_own_noise(whole.record.clone(), highest, whole.numerics.clone());
    let mut experiments = experiments.for_record(&low);
    let mut recommended = current.point();
    recommended.x[..current.model.space.dimension()].fill(0.0);
    let starts = vec![recommended, current.point()];
    let Some(fit) = closest(
        experiments
            .fits(starts, LeastSquaresSettings::short(8))
            .await?,
    ) else {
        return Ok(Vec::new());
    };
    let mut tests = experiments.for_stage(Stage::Test);
    let suspects = signature::examine(&mut tests, &fit, effects).await?;
    let mut order = candidate::ranked(&suspects);
    order.truncate(REFITS);
    let mut refits = refit::refit(&mut experiments, &fit, &order, 0.0).await?;
    refits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let likeliest = refits.iter().take(LIKELIEST);
    Ok(likeliest.map(|refit| refit.fit.point()).collect())
}
