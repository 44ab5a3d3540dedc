//! JSON object of `horsehead simulate`.
use super::score::{ScoreOutput, Unknowns, channels, objective, unknowns};
use crate::cli::output::model;
use protocol::{
    case::Case,
    job::{Counters, Derivative, Reached, Verdict},
    wire::WireError,
};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use study::ComparedCurves;

/// JSON object printed by `horsehead simulate CASE --output json`.
#[derive(Debug, Serialize)]
pub(crate) struct SimulateOutput<'a> {
    pub(crate) case: &'a str,
    pub(crate) condition: &'a str,
    /// How the simulation ended.
    #[serde(flatten)]
    pub(crate) verdict: VerdictOutput,
    /// Wall time of the simulation on the worker (s).
    pub(crate) wall_s: f64,
    /// Counters of the solver's work in the simulation.
    pub(crate) counters: Counters,
    #[serde(flatten)]
    pub(crate) unknowns: Unknowns,
    /// Objective of the simulation, in the square of the unit that its channels share; null if there is no
    /// measured record or the simulation did not complete.
    pub(crate) objective: Option<f64>,
    /// Agreement with the measured record by channel; empty if there is no record.
    pub(crate) channels: BTreeMap<String, ScoreOutput>,
    /// Simulated curves and further results, under keys that depend on the kind of model.
    #[serde(flatten)]
    pub(crate) drawn: Map<String, Value>,
    /// Derivatives of the curves, by name of the unknown or effect parameter; absent if none were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) derivatives: Option<Map<String, Value>>,
    /// Wall time on the worker of the simulation including all derivatives (s); absent if none were
    /// requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) derivatives_wall_s: Option<f64>,
    /// Hash of all bits of the simulation's result.
    pub(crate) digest: String,
}

/// How a simulation ended, and how far it got if it failed.
#[derive(Debug, Serialize)]
pub(crate) struct VerdictOutput {
    /// `complete`, or the kind of failure, for example `load_not_lifted`.
    pub(crate) verdict: String,
    /// Share of the static load that was applied [0, 1]; present only if the simulation failed while loading.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) load_fraction: Option<f64>,
    /// Share of the simulated time that was reached [0, 1]; present only if the simulation failed in motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) time_fraction: Option<f64>,
}

impl From<Verdict> for VerdictOutput {
    fn from(verdict: Verdict) -> Self {
        let (verdict, load_fraction, time_fraction) = match verdict {
            Verdict::Complete => ("complete".to_owned(), None, None),
            Verdict::Failed { kind, reached } => match reached {
                Reached::LoadFraction(share) => (kind.as_str().to_owned(), Some(share), None),
                Reached::TimeFraction(share) => (kind.as_str().to_owned(), None, Some(share)),
            },
        };
        Self {
            verdict,
            load_fraction,
            time_fraction,
        }
    }
}

/// Converts the derivatives of the simulated curves to their JSON form, by name of the unknown or effect
/// parameter: zeros with `nothing` where the curves do not depend on it, `missing` with the reason where
/// there is no derivative.
fn derivatives(
    case: &Case,
    condition: usize,
    curves: &ComparedCurves,
    derived: &[String],
) -> Map<String, Value> {
    let kind = model::of(case);
    let one = |(at, name): (usize, &String)| {
        let said = match curves.drawn.columns.get(at) {
            Some(Derivative::Curves { per, curves }) => {
                Value::Object(kind.derivative(case, condition, per, curves))
            }
            Some(Derivative::Nothing { per }) => {
                let channels = case.channels_of(condition);
                let zeros =
                    channels.map(|(_, channel)| vec![0.0_f32; channel.abscissa.points.len()]);
                let zeros: Vec<Vec<f32>> = zeros.collect();
                let mut said = kind.derivative(case, condition, per, &zeros);
                said.insert("nothing".to_owned(), Value::Bool(true));
                Value::Object(said)
            }
            Some(Derivative::Missing { reason }) => json!({ "missing": reason }),
            None => json!({ "missing": "the simulation did not complete" }),
        };
        (name.clone(), said)
    };
    derived.iter().enumerate().map(one).collect()
}

/// Builds the JSON object of a simulation; `digest` is the hash of its result.
///
/// # Errors
/// If the answer cannot be decoded for this kind of model.
pub(crate) fn simulation<'a>(
    (case, condition): (&'a Case, usize),
    curves: &'a ComparedCurves,
    derived: &[String],
    digest: String,
) -> Result<SimulateOutput<'a>, WireError> {
    let found = case.conditions.get(condition);
    Ok(SimulateOutput {
        case: &case.name,
        condition: found.map_or("", |condition| &condition.name),
        verdict: curves.drawn.verdict.into(),
        wall_s: curves.drawn.wall_s,
        counters: curves.drawn.counters,
        unknowns: unknowns(case, &curves.genes),
        objective: objective(curves.evaluation.as_ref()),
        channels: channels(case, curves.evaluation.as_ref()),
        derivatives: (!derived.is_empty()).then(|| derivatives(case, condition, curves, derived)),
        derivatives_wall_s: (!derived.is_empty()).then_some(curves.drawn.columns_wall_s),
        drawn: model::of(case).drawn(case, condition, &curves.drawn)?,
        digest,
    })
}
