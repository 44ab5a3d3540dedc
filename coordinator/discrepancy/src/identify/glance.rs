//! A first look at what a record sees, from one linearised simulation at parameters that were found elsewhere.
//!
//! Linear throughout, and under the noise of the record alone: no tolerance of an instrument, no numerical
//! error and no refit is in it. What is left widens every interval, as everywhere. It is what a table of a
//! calibration says beside its numbers; [`super::identify`] says it with profiles.
use super::answer::{End, Seen, UnknownEstimate};
use super::settings::FREE;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::unknowns::{Model, Point, Unstated};
use crate::record::whitened::WhitenedRecord;
use crate::size::spread::Spread;
use search::least_squares::Settings;

/// Looks at the calibrated condition's record from where the inputs start; the unknowns that are searched,
/// each with what the record says of it. Nothing where there is no record, no start, or it does not complete.
///
/// # Errors
/// Those of the laboratory.
pub async fn glance<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<Option<Vec<UnknownEstimate>>, L::Error> {
    let record = inputs.records.first().filter(|record| record.is_fitted());
    let (Some(record), Some(x)) = (record, &inputs.start) else {
        return Ok(None);
    };
    let orders = inputs.thresholds.orders;
    let on = WhitenedRecord::under_own_noise(record.free(), orders, inputs.usual.clone());
    let model = Model {
        unstated: Unstated::Bounds,
        ..Model::plain(inputs.space.clone())
    };
    let mut experiments = Experiments {
        lab,
        on: &on,
        stage: Stage::Show,
    };
    let point = Point {
        model,
        x: x.clone(),
    };
    // one Jacobian where it is
    let still = Settings {
        iterations: 1,
        ..FREE
    };
    let Some(fit) = experiments.fit(point, still).await? else {
        return Ok(None);
    };
    let spread = Spread::of(&on.metric, &fit);
    let axes = fit.model.space.axes().iter().enumerate();
    let estimate = axes.map(|(k, axis)| {
        let half = spread.quantile * spread.variance(k).sqrt();
        let (at, bounds) = (fit.x()[k], axis.interval());
        let ends = [at - half > bounds.from, at + half < bounds.to];
        let [below, above] = ends;
        UnknownEstimate {
            name: axis.unknown.name.clone(),
            unit: axis.unknown.unit.clone(),
            value: axis.value(at),
            interval: [
                below.then(|| axis.value(at - half)),
                above.then(|| axis.value(at + half)),
            ],
            ends: ends.map(|rises| if rises { End::Rises } else { End::Bound }),
            seen: Seen::of(below, above),
            correlated: Vec::new(),
            profile: Vec::new(),
        }
    });
    Ok(Some(estimate.collect()))
}
