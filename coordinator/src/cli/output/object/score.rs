//! JSON forms of unknowns and of the agreement with measured records, shared by the objects of several
//! commands.
use crate::cli::output::model;
use discrepancy::identify::{Determination, UnknownEstimate};
use protocol::{
    case::Case,
    job::{ChannelScore, Evaluation, Verdict},
};
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use study::ComparedCurves;

/// Unknown with its value and bounds, in its declared unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct GeneOutput {
    value: f64,
    unit: String,
    recommended: f64,
    lower: f64,
    upper: f64,
    /// First-order identifiability of the unknown; absent if it was not computed.
    #[serde(flatten)]
    seen: Option<IdentifiabilityOutput>,
}

/// Identifiability of an unknown from the measured record.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct IdentifiabilityOutput {
    /// 95 % confidence interval of the unknown; null for an open end, and null as a whole if both ends are
    /// open.
    ci95: Option<[Option<f64>; 2]>,
    seen: Determination,
}

/// Scores of the recommended and the optimised parameters under one condition.
#[derive(Debug, Serialize)]
pub(crate) struct ConditionOutput {
    /// Objective of the recommended and the optimised parameters, in the square of the unit that its channels
    /// share.
    pub(crate) objective: RecommendedAndOptimised<Option<f64>>,
    /// Agreement with the record by channel, for the recommended and the optimised parameters.
    pub(crate) channels: BTreeMap<String, RecommendedAndOptimised<Option<ScoreOutput>>>,
}

/// Pair of results of the same kind, one for the recommended and one for the optimised parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct RecommendedAndOptimised<T> {
    pub(crate) recommended: T,
    pub(crate) optimised: T,
}

/// Unknowns by name, under a JSON key that depends on the kind of model.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Unknowns(BTreeMap<&'static str, BTreeMap<String, GeneOutput>>);

impl Unknowns {
    /// Adds confidence interval and identifiability to every unknown that the given estimates contain.
    pub(crate) fn add_identifiability(&mut self, seen: &[UnknownEstimate]) {
        for (name, own) in self.0.values_mut().flatten() {
            let said = seen.iter().find(|one| one.name == *name);
            own.seen = said.map(|one| IdentifiabilityOutput {
                ci95: (one.seen != Determination::NotSeen).then_some(one.interval),
                seen: one.seen,
            });
        }
    }
}

/// Converts the values of all unknowns of a case to their JSON form.
pub(crate) fn unknowns(case: &Case, values: &[f64]) -> Unknowns {
    let pairs = case.unknowns.iter().zip(values);
    let named = pairs
        .map(|(gene, &value)| {
            let output = GeneOutput {
                value,
                unit: gene.unit.clone(),
                recommended: gene.start,
                lower: gene.lower,
                upper: gene.upper,
                seen: None,
            };
            (gene.name.clone(), output)
        })
        .collect();
    Unknowns(BTreeMap::from([(
        case::kind::of(case).unknowns_key(),
        named,
    )]))
}

/// Agreement between simulation and record in one channel, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct ScoreOutput {
    unit: String,
    mse: f64,
    mse_fixed_offset: f64,
    offset: f64,
    rmse_over_half_range: f64,
    relative_error: f64,
    peak_to_peak_error: f64,
    /// Further scores of the channel that only this kind of model has, by name.
    #[serde(flatten)]
    own: Map<String, Value>,
}

/// Returns the agreement with the record by channel; the kind of model determines the key of each channel.
pub(crate) fn channels(
    case: &Case,
    evaluation: Option<&Evaluation>,
) -> BTreeMap<String, ScoreOutput> {
    let scores = evaluation.map_or(&[][..], |evaluation| &evaluation.channels);
    let output = |score: &ChannelScore| {
        let channel = case.channels.get(score.channel)?;
        let (key, own) = model::of(case).scored(channel, score);
        let output = ScoreOutput {
            unit: channel.unit.clone(),
            mse: score.mse,
            mse_fixed_offset: score.mse_fixed_offset,
            offset: score.offset,
            rmse_over_half_range: score.rmse_over_half_range,
            relative_error: score.relative_error,
            peak_to_peak_error: score.peak_to_peak_error,
            own,
        };
        Some((key, output))
    };
    scores.iter().filter_map(output).collect()
}

/// Returns the objective of a completed simulation; `None` if there is none.
pub(crate) fn objective(evaluation: Option<&Evaluation>) -> Option<f64> {
    let complete = evaluation.filter(|evaluation| evaluation.verdict == Verdict::Complete)?;
    Some(complete.fitness)
}

/// Pairs the scores of the recommended and the optimised parameters under one condition.
pub(crate) fn condition(
    case: &Case,
    recommended: &ComparedCurves,
    optimised: &ComparedCurves,
) -> ConditionOutput {
    let [before, after] =
        [recommended, optimised].map(|one| channels(case, one.evaluation.as_ref()));
    let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let both = names.into_iter().map(|name| {
        let scores = RecommendedAndOptimised {
            recommended: before.get(name).cloned(),
            optimised: after.get(name).cloned(),
        };
        (name.clone(), scores)
    });
    let channels = both.collect();
    ConditionOutput {
        objective: RecommendedAndOptimised {
            recommended: objective(recommended.evaluation.as_ref()),
            optimised: objective(optimised.evaluation.as_ref()),
        },
        channels,
    }
}
