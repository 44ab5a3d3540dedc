//! JSON object of `horsehead identify`.
use crate::cli::output::model;
use discrepancy::{
    diagnose::NuisanceEstimate,
    identify::{Determination, Direction, FurtherMeasurement, UnknownEstimate},
};
use report::identification::IdentificationInput;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// JSON object printed by `horsehead identify CASE --output json`: what the measured records determine.
#[derive(Debug, Serialize)]
pub(crate) struct IdentifyOutput {
    run: String,
    case: String,
    /// Estimates and confidence intervals of the unknowns, by name.
    unknowns: BTreeMap<String, UnknownOutput>,
    /// Directions in the space of unknowns, ordered from the best determined to the undetermined ones.
    directions: Vec<Direction>,
    /// Prediction bands of the channels, by condition name.
    prediction: BTreeMap<String, Map<String, Value>>,
    nuisances: Vec<NuisanceEstimate>,
    /// Proposed further measurements, each with the unknowns that it would determine better.
    further: Vec<FurtherMeasurement>,
    /// Root mean square of the residual divided by that of the measurement noise [1].
    times_noise: f64,
    /// Whether the residual exceeds the measurement noise: the confidence intervals are then widened, or absent where
    /// it is a multiple, and a diagnosis should be run first.
    diagnose_first: bool,
    assumed_noise: bool,
    notes: Vec<String>,
    /// Number of simulations that the analysis requested in all its stages.
    simulations: u64,
    wall_s: f64,
}

/// Unknown with its estimate, interval, correlations and likelihood profile.
#[derive(Debug, Serialize)]
struct UnknownOutput {
    value: f64,
    unit: String,
    /// 95 % confidence interval of the unknown; null for an open end, and null as a whole if both ends are
    /// open, or if the fit leaves a multiple of the noise.
    ci95: Option<[Option<f64>; 2]>,
    /// Sides on which the record bounds the unknown; null if the fit leaves a multiple of the noise.
    seen: Option<Determination>,
    correlated_with: Vec<CorrelationOutput>,
    /// Reason why the likelihood profile of the unknown ends, for each side: `rises`, `bound`, `fails`,
    /// `given_up`, `not_followed`.
    ends: [discrepancy::identify::IntervalEnd; 2],
    /// Likelihood profile of the unknown: pairs of its value and the increase of -2 ln L over the minimum,
    /// with all other unknowns refitted.
    profile: Vec<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct CorrelationOutput {
    name: String,
    correlation: f64,
}

fn unknown(own: &UnknownEstimate, has_intervals: bool) -> UnknownOutput {
    let correlated = own.correlated.iter();
    UnknownOutput {
        value: own.value,
        unit: own.unit.clone(),
        ci95: (own.seen != Determination::NotSeen).then_some(own.interval),
        seen: has_intervals.then_some(own.seen),
        correlated_with: correlated
            .map(|(name, correlation)| CorrelationOutput {
                name: name.clone(),
                correlation: *correlation,
            })
            .collect(),
        ends: own.ends,
        profile: own.profile.clone(),
    }
}

/// Builds the JSON object of an identifiability analysis.
pub(crate) fn object(subject: &IdentificationInput<'_>, simulations: u64) -> IdentifyOutput {
    let (case, identified) = (subject.case, subject.identified);
    let unknowns = identified.unknowns.iter();
    let bands = identified.bands.iter();
    let notes = subject.notes.iter().chain(&identified.notes);
    IdentifyOutput {
        run: subject.origin.run.clone(),
        case: case.name.clone(),
        unknowns: unknowns
            .map(|own| (own.name.clone(), unknown(own, identified.has_intervals)))
            .collect(),
        directions: identified.directions.clone(),
        prediction: bands
            .map(|band| {
                let name = case.conditions[band.condition].name.clone();
                (name, model::of(case).predicted(case, band))
            })
            .collect(),
        nuisances: identified.nuisances.clone(),
        further: identified.further.clone(),
        times_noise: identified.left.sqrt(),
        diagnose_first: !identified.is_noise,
        assumed_noise: !identified.noise.is_seen(),
        notes: notes.cloned().collect(),
        simulations,
        wall_s: subject.wall_s,
    }
}

#[cfg(test)]
mod tests;
