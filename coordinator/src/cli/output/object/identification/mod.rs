//! Of `horsehead identify`.
use crate::kind;
use discrepancy::{
    diagnose::NeverExact,
    identify::{Direction, Further, Seen, UnknownEstimate},
    laboratory::Stage,
};
use report::identification::Subject;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use study::StageCost;

/// What a record sees.
#[derive(Debug, Serialize)]
pub(crate) struct IdentifyOutput {
    run: String,
    case: String,
    /// By name.
    unknowns: BTreeMap<String, UnknownOutput>,
    /// From the best seen to the blind ones.
    directions: Vec<Direction>,
    /// By condition.
    prediction: BTreeMap<String, Map<String, Value>>,
    nuisances: Vec<NeverExact>,
    /// What further measurements would pin down.
    further: Vec<Further>,
    /// How many times the noise the fit leaves: root mean square over that of the noise.
    times_noise: f64,
    /// Whether that is more than noise: then intervals are widened, and a diagnosis comes first.
    diagnose_first: bool,
    assumed_noise: bool,
    notes: Vec<String>,
    /// Simulations, by how they were asked for.
    simulations: u64,
    wall_s: f64,
}

/// An unknown with what the record says of it.
#[derive(Debug, Serialize)]
struct UnknownOutput {
    value: f64,
    unit: String,
    /// Null for an open end; null as a whole where both are open.
    ci95: Option<[Option<f64>; 2]>,
    seen: Seen,
    correlated_with: Vec<CorrelationOutput>,
    /// How each side ends: `rises`, `bound`, `fails`, `given_up`.
    ends: [discrepancy::identify::End; 2],
    /// Values with the rise of -2 ln L, all else refitted.
    profile: Vec<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct CorrelationOutput {
    name: String,
    correlation: f64,
}

fn unknown(own: &UnknownEstimate) -> UnknownOutput {
    let correlated = own.correlated.iter();
    UnknownOutput {
        value: own.value,
        unit: own.unit.clone(),
        ci95: (own.seen != Seen::NotSeen).then_some(own.interval),
        seen: own.seen,
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

/// The object.
pub(crate) fn object(subject: &Subject<'_>, accounts: &[(Stage, StageCost)]) -> IdentifyOutput {
    let (case, identified) = (subject.case, subject.identified);
    let unknowns = identified.unknowns.iter();
    let bands = identified.bands.iter();
    let notes = subject.notes.iter().chain(&identified.notes);
    IdentifyOutput {
        run: subject.origin.run.clone(),
        case: case.name.clone(),
        unknowns: unknowns
            .map(|own| (own.name.clone(), unknown(own)))
            .collect(),
        directions: identified.directions.clone(),
        prediction: bands
            .map(|band| {
                let name = case.conditions[band.condition].name.clone();
                (name, kind::of(case).predicted(case, band))
            })
            .collect(),
        nuisances: identified.nuisances.clone(),
        further: identified.further.clone(),
        times_noise: identified.left.sqrt(),
        diagnose_first: !identified.is_noise,
        assumed_noise: !identified.noise.is_seen(),
        notes: notes.cloned().collect(),
        simulations: accounts.iter().map(|(_, cost)| cost.experiments).sum(),
        wall_s: subject.wall_s,
    }
}

#[cfg(test)]
mod tests;
