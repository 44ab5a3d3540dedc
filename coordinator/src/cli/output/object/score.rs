//! Genes and agreement with the record, alike in all objects.
use crate::study::Curves;
use protocol::{
    case::Case,
    job::{ChannelScore, Evaluation, Verdict},
};
use serde::Serialize;
use std::collections::BTreeMap;

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
    /// Objective of both parameter sets `MPa^2`.
    pub(crate) objective: Both<Option<f64>>,
    /// Agreement by gauge number, of both parameter sets.
    pub(crate) channels: BTreeMap<String, Both<Option<ChannelScore>>>,
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
    let pairs = case.genes.iter().zip(values);
    pairs
        .map(|(gene, &value)| {
            let output = GeneOutput {
                value,
                unit: gene.unit().to_owned(),
                recommended: gene.recommended,
                lower: gene.lower,
                upper: gene.upper,
            };
            (gene.label(), output)
        })
        .collect()
}

/// Agreement by gauge number.
pub(crate) fn channels(evaluation: Option<&Evaluation>) -> BTreeMap<String, ChannelScore> {
    let scores = evaluation.map_or(&[][..], |evaluation| &evaluation.channels);
    let numbered = scores.iter().map(|score| (score.gauge.to_string(), *score));
    numbered.collect()
}

/// The objective of a complete run.
pub(crate) fn objective(evaluation: Option<&Evaluation>) -> Option<f64> {
    let complete = evaluation.filter(|evaluation| evaluation.verdict == Verdict::Complete)?;
    Some(complete.fitness)
}

/// Scores of both parameter sets, recommended first.
pub(crate) fn condition(recommended: &Curves, optimised: &Curves) -> ConditionOutput {
    let (mut before, mut after) = (
        channels(recommended.evaluation.as_ref()),
        channels(optimised.evaluation.as_ref()),
    );
    let gauges: Vec<String> = before.keys().chain(after.keys()).cloned().collect();
    let both = gauges.into_iter().map(|gauge| {
        let scores = Both {
            recommended: before.remove(&gauge),
            optimised: after.remove(&gauge),
        };
        (gauge, scores)
    });
    let mut channels = BTreeMap::new();
    for (gauge, scores) in both {
        channels.entry(gauge).or_insert(scores);
    }
    ConditionOutput {
        objective: Both {
            recommended: objective(recommended.evaluation.as_ref()),
            optimised: objective(optimised.evaluation.as_ref()),
        },
        channels,
    }
}
