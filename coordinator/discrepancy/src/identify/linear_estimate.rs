//! Quick linear identifiability analysis from one linearised simulation at given parameters.
//!
//! It assumes the noise of the record alone, without instrument tolerances, numerical error or refits. A
//! residual above the noise widens every interval. The result accompanies the table of a calibration;
//! [`super::identify`] computes profile likelihoods instead.
use super::answer::{Determination, IntervalEnd, UnknownEstimate};
use super::settings::FREE;
use crate::estimate::neighbourhood::{Neighbourhood, NoNeighbourhood};
use crate::estimate::spread::Spread;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::{DefaultPrior, FittedModel, Point};
use protocol::case::Scale;
use record::Curves;
use search::least_squares::LeastSquaresSettings;

/// Linear estimate of the searched unknowns at given parameters.
#[derive(Clone, Debug)]
pub struct LinearEstimate {
    /// Searched unknowns with their intervals.
    pub unknowns: Vec<UnknownEstimate>,
    /// Derivatives of the simulated channels of the record by each searched unknown: per decade on a logarithmic scale, else
    /// per declared unit. Channels without an absolute zero have derivatives up to a constant.
    pub derivatives: Vec<Curves>,
    /// Index of each channel of the record among the channels of its condition.
    pub channels: Vec<usize>,
}

/// Estimates the searched unknowns to first order from the record of the calibrated condition, at the start point that the
/// inputs state. Returns `None` without a record or a start point, or if the simulation does not complete.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn linear_estimate<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<Option<LinearEstimate>, L::Error> {
    let Some((on, fit)) = linearized_at_start(lab, inputs).await? else {
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
            ends: ends.map(|rises| {
                if rises {
                    IntervalEnd::Rises
                } else {
                    IntervalEnd::Bound
                }
            }),
            seen: Determination::of(below, above),
            correlated: Vec::new(),
            profile: Vec::new(),
        }
    });
    let jacobian = &fit.search.best().jacobian;
    let derivatives = fit.model.space.axes().iter().enumerate().map(|(k, axis)| {
        let unknown = &axis.unknown;
        // the residual is measured less simulated
        let coordinates = match unknown.scale {
            Scale::Logarithmic => -1.0,
            Scale::Linear => -2.0 / (unknown.upper - unknown.lower),
        };
        let column = jacobian.column(k) * coordinates;
        on.metric.curves(&column.into_owned())
    });
    Ok(Some(LinearEstimate {
        unknowns: estimate.collect(),
        derivatives: derivatives.collect(),
        channels: on.record.channels.iter().map(|own| own.curve).collect(),
    }))
}

/// Collects individuals about the start point that the inputs state, from the record of the calibrated condition. Returns
/// `None` as [`linear_estimate`].
///
/// # Errors
/// As [`linear_estimate`].
pub async fn neighbourhood_at_start<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<Option<Result<Neighbourhood, NoNeighbourhood>>, L::Error> {
    let Some((on, fit)) = linearized_at_start(lab, inputs).await? else {
        return Ok(None);
    };
    let spread = Spread::of(&on.metric, &fit);
    let mut experiments = Experiments {
        lab,
        on: &on,
        stage: Stage::Show,
    };
    let found = Neighbourhood::around(&mut experiments, &fit, &spread).await?;
    Ok(Some(found))
}

/// Returns the record of the calibrated condition under its own noise, and the model with its derivatives at the start
/// point.
async fn linearized_at_start<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<Option<(WhitenedRecord, Fit)>, L::Error> {
    let record = inputs.records.first().filter(|record| record.is_fitted());
    let (Some(record), Some(x)) = (record, &inputs.start) else {
        return Ok(None);
    };
    let orders = inputs.thresholds.orders;
    let on = WhitenedRecord::under_own_noise(record.free(), orders, inputs.usual.clone());
    let model = FittedModel {
        unstated: DefaultPrior::Bounds,
        ..FittedModel::plain(inputs.space.clone())
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
    let still = LeastSquaresSettings {
        iterations: 1,
        ..FREE
    };
    let fit = experiments.fit(point, still).await?;
    Ok(fit.map(|fit| (on, fit)))
}
