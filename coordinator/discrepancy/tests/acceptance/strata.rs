//! Strata of true machines on which the pipeline is tested.
use crate::healthy::healthy;
use crate::trial::MACHINE;
use crate::truth::{Truth, Unlisted};
use discrepancy::diagnose::Limit;
use discrepancy::model::{shapes, sizes};
use protocol::announce::{EffectDescriptor, Sign};
use search::random::{Phase, Streams};

/// Noise levels of the strata, as factors of the usual noise.
pub(crate) const NOISES: [f64; 3] = [0.3, 1.0, 3.0];

/// Returns the machine of a stratum in which the `k`-th effect is planted; the noise level cycles through
/// [`NOISES`] with effect and seed. Strata that plant at other multiples share the machine.
pub(crate) fn machine(k: usize, seed: u64) -> Truth {
    let level = (k + seed as usize) % NOISES.len();
    Truth::healthy(100 + 100 * k as u64 + seed).noisy(NOISES[level])
}

/// Returns the detection limits that a diagnosis of a machine prints with the same noise and no hidden
/// effect; if its recalibration does not converge, those of a similar healthy machine.
pub(crate) fn limits(truth: &Truth) -> Vec<Limit> {
    let own = healthy(truth.seed, truth.noise);
    if own.limits.is_empty() {
        return healthy(9001, truth.noise).limits.clone();
    }
    own.limits.clone()
}

/// Returns the effects of the library that have a physical cause.
pub(crate) fn named() -> Vec<&'static EffectDescriptor> {
    MACHINE.library().iter().filter(|e| !e.generic).collect()
}

/// Plants an effect of the library at a multiple of its detection limit: one of its sizes is set, and its
/// shape parameters take values that the library does not try.
pub(crate) fn planted(truth: Truth, effect: &EffectDescriptor, multiple: f64) -> Truth {
    let limits = limits(&truth);
    planted_at(truth, effect, multiple, &limits)
}

/// Plants an effect at a multiple of the given limits, e.g. those of a subset of the channels.
pub(crate) fn planted_at(
    truth: Truth,
    effect: &EffectDescriptor,
    multiple: f64,
    limits: &[Limit],
) -> Truth {
    let mut stream = Streams::new(truth.seed, 23).at(0, Phase::Initial, effect.id.len());
    let mut amounts: Vec<f64> = effect.parameters.iter().map(|p| p.absent).collect();
    let choices = sizes(effect);
    let k = choices[stream.index(choices.len())];
    let parameter = &effect.parameters[k];
    let limit = limits
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

/// Effects outside the library, at detectable sizes, each with the joint and forms of the generic force that
/// describes it.
pub(crate) const OUTSIDE: [(Unlisted, &str, &[&str]); 6] = [
    (Unlisted::BeamSpring(1.2), "beam", &["d3", "cos1"]),
    (Unlisted::BeamDrag(0.3), "beam", &["v2"]),
    (Unlisted::HeadThrice(0.4), "head", &["cos3", "sin3"]),
    (Unlisted::RodDashpot(0.5), "rod", &["v"]),
    (Unlisted::GearMesh(1.0), "crank", &["cos4", "sin4"]),
    (Unlisted::GearFriction(1.0), "crank", &["sgn_v"]),
];
