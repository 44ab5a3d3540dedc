//! Effects that a record cannot show because the unknowns absorb them, with the measurement that would reveal
//! each.
use crate::hypothesis::candidate::WorkingCandidate;
use crate::hypothesis::round::WorkingRound;
use crate::linear::tangent::Tangent;
use crate::model::fit::Fit;
use nalgebra::DMatrix;
use search::least_squares::Variable;
use serde::{Deserialize, Serialize};

/// Effect that recalibration absorbs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Absorbed {
    /// Identifier of the effect.
    pub id: String,
    /// Share of the effect's signature that the unknowns absorb, 0 to 1.
    pub share: f64,
    /// Measurement that would show the effect.
    pub measurement: String,
}

/// Share of an effect's signature that the unknowns must absorb for the effect to be reported as absorbed.
const MOST: f64 = 0.9;
/// Maximum number of absorbed effects that are reported.
const MAX_REPORTED: usize = 8;
/// Minimum share of an effect that a separate test of an unknown must make visible to be recommended.
const MIN_VISIBLE_SHARE: f64 = 0.2;

/// Returns the effects of a round that are almost completely absorbed at a fit, the largest share first.
pub(crate) fn absorbed(round: &WorkingRound, fit: &Fit) -> Vec<Absorbed> {
    let tangent = fit.tangent();
    // of what is not in proportion to its size only a refit says so
    let refuted = |id: &str| {
        let mut refits = round.refits.iter();
        refits.any(|own| own.id == id && own.log_evidence <= round.null_evidence)
    };
    let visible = round.candidates.iter().filter(|suspect| {
        let moves = suspect.signature.norm_squared() > 0.0;
        moves && (suspect.linear || refuted(&suspect.effect.id))
    });
    let mut all: Vec<(f64, &WorkingCandidate)> = visible
        .map(|suspect| (taken(&suspect.signature, &tangent), suspect))
        .filter(|(share, _)| *share >= MOST)
        .collect();
    all.sort_by(|(a, one), (b, other)| b.total_cmp(a).then(one.effect.id.cmp(&other.effect.id)));
    all.truncate(MAX_REPORTED);
    let told = |(share, suspect): (f64, &WorkingCandidate)| Absorbed {
        id: suspect.effect.id.clone(),
        share,
        measurement: measurement(suspect, fit),
    };
    all.into_iter().map(told).collect()
}

/// Returns the share of an effect's signature that lies in a tangent space, so that the unknowns absorb it.
fn taken(signature: &DMatrix<f64>, tangent: &Tangent) -> f64 {
    let whole = signature.norm_squared();
    let left = signature.dot(&tangent.project_columns(signature));
    if whole > 0.0 {
        (1.0 - left / whole).clamp(0.0, 1.0)
    } else {
        1.0
    }
}

/// Describes the measurement that would show the effect: a separate test of the unknown that absorbs most of
/// it, or a sensor at the place where the effect acts.
fn measurement(suspect: &WorkingCandidate, fit: &Fit) -> String {
    let axes = fit.model.space.axes();
    let without = |k: usize| {
        let mut variables: Vec<Variable> = fit.variables().to_vec();
        // what stands at its bound takes nothing up
        variables[k].lower = fit.x()[k];
        taken(
            &suspect.signature,
            &Tangent::new(fit.search.best(), &variables),
        )
    };
    let least = (0..axes.len())
        .map(|k| (without(k), k))
        .min_by(|(a, _), (b, _)| a.total_cmp(b));
    let joint = suspect.effect.joint.replace('_', " ");
    let sensor = if joint.is_empty() {
        "a sensor at the place where the effect acts".to_owned()
    } else {
        format!("a sensor at the {joint}")
    };
    match least {
        Some((share, k)) if 1.0 - share >= MIN_VISIBLE_SHARE => format!(
            "a separate test that determines {} ({:.0} % of the effect would then be visible), or {sensor}",
            axes[k].unknown.name,
            100.0 * (1.0 - share)
        ),
        _ => sensor,
    }
}
