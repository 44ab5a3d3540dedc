//! The strata of truths that the pipeline is held against.
use crate::trial::{MACHINE, diagnose_usual};
use crate::truth::{Truth, Unlisted};
use discrepancy::diagnose::Limit;
use discrepancy::model::{shapes, sizes};
use discrepancy::verdict::Verdict;
use protocol::announce::{EffectDescriptor, Sign};
use search::random::{Phase, Streams};
use std::sync::LazyLock;

/// Levels of noise, as factors of the usual one, through which strata go.
pub(crate) const NOISES: [f64; 3] = [0.3, 1.0, 3.0];

/// Detection limits as a diagnosis of a healthy machine prints them, by level of noise.
static LIMITS: [LazyLock<Vec<Limit>>; 3] = [
    LazyLock::new(|| healthy(NOISES[0])),
    LazyLock::new(|| healthy(NOISES[1])),
    LazyLock::new(|| healthy(NOISES[2])),
];

fn healthy(noise: f64) -> Vec<Limit> {
    let healthy = diagnose_usual(&Truth::healthy(9001).noisy(noise));
    assert_eq!(
        healthy.verdict,
        Verdict::NothingDetected,
        "the limits come from a healthy machine"
    );
    healthy.limits
}

/// The detection limits at one of [`NOISES`].
pub(crate) fn limits(noise: f64) -> &'static [Limit] {
    let level = NOISES.iter().position(|n| n.total_cmp(&noise).is_eq());
    &LIMITS[level.expect("a level that strata go through")]
}

/// The named effects.
pub(crate) fn named() -> Vec<&'static EffectDescriptor> {
    MACHINE.library().iter().filter(|e| !e.generic).collect()
}

/// An effect of the library at a multiple of its limit: one of its sizes, its shapes where the
/// library tries none.
pub(crate) fn planted(truth: Truth, effect: &EffectDescriptor, multiple: f64) -> Truth {
    let mut stream = Streams::new(truth.seed, 23).at(0, Phase::Initial, effect.id.len());
    let mut amounts: Vec<f64> = effect.parameters.iter().map(|p| p.absent).collect();
    let choices = sizes(effect);
    let k = choices[stream.index(choices.len())];
    let parameter = &effect.parameters[k];
    let limit = limits(truth.noise)
        .iter()
        .find(|l| l.id == effect.id && l.parameter == parameter.name)
        .map_or(f64::INFINITY, |l| l.size);
    let negative = parameter.sign == Sign::Either && stream.chance(0.5);
    amounts[k] = (multiple * limit).min(parameter.upper) * if negative { -1.0 } else { 1.0 };
    for k in shapes(effect) {
        let p = &effect.parameters[k];
        amounts[k] = p.typical + 0.25 * (p.upper - p.lower) * (2.0 * stream.unit() - 1.0);
    }
    truth.with(&effect.id, &amounts)
}

/// What is outside the library, at sizes that show: with the joints and forms that describe it.
pub(crate) const OUTSIDE: [(Unlisted, &str, &[&str]); 5] = [
    (Unlisted::BeamSpring(1.2), "beam", &["d3", "cos1"]),
    (Unlisted::HeadThrice(0.4), "head", &["cos3", "sin3"]),
    (Unlisted::RodDashpot(0.5), "rod", &["v"]),
    (Unlisted::GearMesh(1.0), "crank", &["cos4", "sin4"]),
    (Unlisted::GearFriction(1.0), "crank", &["sgn_v"]),
];
