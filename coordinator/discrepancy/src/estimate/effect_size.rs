//! Effects of the answer, with their estimated sizes and intervals.
use crate::estimate::spread::Spread;
use crate::hypothesis::round::WorkingRound;
use crate::linear::score::family_wise;
use crate::model::fit::Fit;
use record::metric::Metric;
use serde::{Deserialize, Serialize};

/// Estimate of one effect that the diagnosis added to the model, or that the record cannot distinguish from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Identifier of the effect.
    pub id: String,
    /// Title of the effect in words.
    pub title: String,
    /// Indices in the case of the unknowns that the effect stands for, parameter by parameter, if they were
    /// off; the estimates are start values for them. Empty for an effect of the library.
    pub unknowns: Vec<usize>,
    /// Estimates of the parameters, in the effect's order.
    pub parameters: Vec<ParameterEstimate>,
    /// Family-wise p-value of the effect's score test.
    pub p_value: f64,
    /// Log evidence of the model with the effect against the model without it, divided by the dispersion
    /// (nats).
    pub ln_evidence: f64,
}

/// Estimate of a parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterEstimate {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter.
    pub unit: String,
    /// Most likely value of the parameter.
    pub value: f64,
    /// 95 % interval of the parameter.
    pub interval: [f64; 2],
}

/// Returns the estimates of the added effects, then those of the other members of their ambiguity sets.
pub(crate) fn estimates(rounds: &[WorkingRound], after: &Fit, metric: &Metric) -> Vec<Estimate> {
    let mut found: Vec<Estimate> = Vec::new();
    for added_first in [true, false] {
        for round in rounds {
            let members = round
                .set
                .iter()
                .filter(|id| (round.added.as_ref() == Some(id)) == added_first);
            for id in members {
                if found.iter().all(|e| e.id != *id) {
                    found.extend(estimate(round, id, (after, metric)));
                }
            }
        }
    }
    found
}

/// Estimates an effect: an added effect from the final model, together with all other added effects; a rival
/// from its own refit.
fn estimate(round: &WorkingRound, id: &str, (after, metric): (&Fit, &Metric)) -> Option<Estimate> {
    if after.model.added.iter().any(|own| own.id == id) {
        let refitted = round.refits.iter().find(|r| r.id == id);
        let log_evidence = refitted.map_or_else(|| after.log_evidence(), |own| own.log_evidence);
        sized(round, id, (after, metric), log_evidence)
    } else {
        refitted(round, id, metric)
    }
}

/// Estimates a candidate effect from its own refit.
pub(crate) fn refitted(round: &WorkingRound, id: &str, metric: &Metric) -> Option<Estimate> {
    let own = round.refits.iter().find(|r| r.id == id)?;
    sized(round, id, (&own.fit, metric), own.log_evidence)
}

fn sized(
    round: &WorkingRound,
    id: &str,
    (fit, metric): (&Fit, &Metric),
    log_evidence: f64,
) -> Option<Estimate> {
    let position = fit.model.added.iter().position(|e| e.id == id)?;
    let effect = &fit.model.added[position];
    let first = fit.model.first_of(position);
    let spread = Spread::of(metric, fit);
    let parameters = effect.parameters.iter().enumerate().map(|(k, p)| {
        let half = spread.quantile * spread.variance(first + k).sqrt() * p.scale;
        let value = (p.absent + fit.x()[first + k] * p.scale).clamp(p.lower, p.upper);
        ParameterEstimate {
            name: p.name.clone(),
            unit: p.unit.clone(),
            value,
            interval: [(value - half).max(p.lower), (value + half).min(p.upper)],
        }
    });
    let suspect = round.candidates.iter().find(|s| s.effect.id == id);
    Some(Estimate {
        id: id.to_owned(),
        title: effect.title.clone(),
        unknowns: fit
            .model
            .off
            .iter()
            .find(|off| off.candidate.id == id)
            .map_or_else(Vec::new, |off| off.positions.clone()),
        parameters: parameters.collect(),
        p_value: suspect.map_or(1.0, |s| family_wise(s.p_value(), round.candidates.len())),
        ln_evidence: round.nats(log_evidence),
    })
}
