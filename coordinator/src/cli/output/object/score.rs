//! Genes and agreement with the record, alike in all objects.
use crate::study::Curves;
use protocol::{
    case::Case,
    job::{ChannelScore, Evaluation, Verdict},
    pumping_unit::Sensor,
};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A gene with its interval, in its declared unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct GeneOutput {
    value: f64,
    unit: String,
    recommended: f64,
    lower: f64,
    upper: f64,
}

/// Scores of both parameter sets under one condition.
#[derive(Debug, Serialize)]
pub(crate) struct ConditionOutput {
    /// Objective of both parameter sets, in the square of the unit that its channels share.
    pub(crate) objective: Both<Option<f64>>,
    /// Agreement by channel, of both parameter sets.
    pub(crate) channels: BTreeMap<String, Both<Option<ScoreOutput>>>,
}

/// One thing for each parameter set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Both<T> {
    /// Of the recommended parameters.
    pub(crate) recommended: T,
    /// Of the optimised parameters.
    pub(crate) optimised: T,
}

/// Genes by name.
pub(crate) fn genes(case: &Case, values: &[f64]) -> BTreeMap<String, GeneOutput> {
    let pairs = case.unknowns.iter().zip(values);
    pairs
        .map(|(gene, &value)| {
            let output = GeneOutput {
                value,
                unit: gene.unit.clone(),
                recommended: gene.start,
                lower: gene.lower,
                upper: gene.upper,
            };
            (gene.name.clone(), output)
        })
        .collect()
}

/// Agreement of one channel, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct ScoreOutput {
    unit: String,
    mse: f64,
    mse_fixed_offset: f64,
    offset: f64,
    rmse_over_half_range: f64,
    relative_error: f64,
    peak_to_peak_error: f64,
    #[serde(flatten)]
    gauge: Option<GaugeOutput>,
}

/// The same of a gauge by its number, with the unit in the names.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct GaugeOutput {
    gauge: u8,
    mse_mpa2: f64,
    mse_fixed_offset_mpa2: f64,
    offset_mpa: f64,
}

/// Agreement by channel: gauges by their numbers, others by their names.
pub(crate) fn channels(
    case: &Case,
    evaluation: Option<&Evaluation>,
) -> BTreeMap<String, ScoreOutput> {
    let scores = evaluation.map_or(&[][..], |evaluation| &evaluation.channels);
    let output = |score: &ChannelScore| {
        let channel = case.channels.get(score.channel)?;
        let gauge = Sensor::gauge(&channel.name);
        let output = ScoreOutput {
            unit: channel.unit.clone(),
            mse: score.mse,
            mse_fixed_offset: score.mse_fixed_offset,
            offset: score.offset,
            rmse_over_half_range: score.rmse_over_half_range,
            relative_error: score.relative_error,
            peak_to_peak_error: score.peak_to_peak_error,
            gauge: gauge.map(|gauge| GaugeOutput {
                gauge,
                mse_mpa2: score.mse,
                mse_fixed_offset_mpa2: score.mse_fixed_offset,
                offset_mpa: score.offset,
            }),
        };
        let key = gauge.map_or_else(|| channel.name.clone(), |gauge| gauge.to_string());
        Some((key, output))
    };
    scores.iter().filter_map(output).collect()
}

/// The objective of a complete run.
pub(crate) fn objective(evaluation: Option<&Evaluation>) -> Option<f64> {
    let complete = evaluation.filter(|evaluation| evaluation.verdict == Verdict::Complete)?;
    Some(complete.fitness)
}

/// Scores of both parameter sets, recommended first.
pub(crate) fn condition(case: &Case, recommended: &Curves, optimised: &Curves) -> ConditionOutput {
    let [before, after] =
        [recommended, optimised].map(|one| channels(case, one.evaluation.as_ref()));
    let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let both = names.into_iter().map(|name| {
        let scores = Both {
            recommended: before.get(name).cloned(),
            optimised: after.get(name).cloned(),
        };
        (name.clone(), scores)
    });
    let channels = both.collect();
    ConditionOutput {
        objective: Both {
            recommended: objective(recommended.evaluation.as_ref()),
            optimised: objective(optimised.evaluation.as_ref()),
        },
        channels,
    }
}
