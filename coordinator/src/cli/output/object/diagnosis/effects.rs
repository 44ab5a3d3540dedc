//! JSON forms of the effects, suspected effects and generic forces of a diagnosis, with their sizes and
//! tests.
use super::gap::{GapOutput, gap};
use discrepancy::diagnose::{Diagnosis, Estimate, ForceEstimate, ParameterEstimate, Round};
use serde::Serialize;
use std::collections::BTreeMap;

/// Effect found by a diagnosis, with its estimated parameters and its statistical test.
#[derive(Debug, Serialize)]
pub(super) struct EffectOutput {
    id: String,
    title: String,
    added: bool,
    parameters: BTreeMap<String, ParameterOutput>,
    p_value: f64,
    ln_evidence: f64,
}

#[derive(Debug, Serialize)]
struct ParameterOutput {
    value: f64,
    unit: String,
    ci95: [f64; 2],
}

/// Round of the search for effects: its statistical test, the suspected effects, and the effect that was
/// added.
#[derive(Debug, Serialize)]
pub(super) struct RoundOutput {
    p_value: f64,
    dispersion: f64,
    added: Option<String>,
    set: Vec<String>,
    reason: Option<String>,
    suspects: Vec<SuspectOutput>,
}

/// Suspected effect in a round: its score test, and the results of its refit if it was refitted.
#[derive(Debug, Serialize)]
struct SuspectOutput {
    id: String,
    p_value: f64,
    statistic: f64,
    absorbed: Option<f64>,
    /// Parameters estimated when the model is refitted with this effect, whether or not the verdict names the
    /// effect; null without a refit.
    parameters: Option<BTreeMap<String, ParameterOutput>>,
    ln_evidence: Option<f64>,
}

/// Generic force: a force at a joint, of a given form but with no named cause.
#[derive(Debug, Serialize)]
pub(super) struct ForceOutput {
    id: String,
    joint: String,
    form: String,
    amplitude: ParameterOutput,
    /// Phase of a harmonic force (degrees); null for other forms.
    phase_deg: Option<f64>,
    ln_evidence: f64,
    gap: GapOutput,
}

fn parameter(own: &ParameterEstimate) -> (String, ParameterOutput) {
    let output = ParameterOutput {
        value: own.value,
        unit: own.unit.clone(),
        ci95: own.interval,
    };
    (own.name.clone(), output)
}

pub(super) fn effect(diagnosis: &Diagnosis, found: &Estimate) -> EffectOutput {
    EffectOutput {
        id: found.id.clone(),
        title: found.title.clone(),
        added: diagnosis
            .rounds
            .iter()
            .any(|round| round.added.as_ref() == Some(&found.id)),
        parameters: found.parameters.iter().map(parameter).collect(),
        p_value: found.p_value,
        ln_evidence: found.ln_evidence,
    }
}

pub(super) fn force(found: &ForceEstimate) -> ForceOutput {
    ForceOutput {
        id: found.id.clone(),
        joint: found.joint.clone(),
        form: found.form.clone(),
        amplitude: ParameterOutput {
            value: found.amplitude,
            unit: found.unit.clone(),
            ci95: found.interval,
        },
        phase_deg: found.phase_deg,
        ln_evidence: found.ln_evidence,
        gap: gap(&found.rows),
    }
}

pub(super) fn rounds(diagnosis: &Diagnosis) -> Vec<RoundOutput> {
    let round = |(at, round): (usize, &Round)| RoundOutput {
        p_value: round.p_value,
        dispersion: round.dispersion,
        added: round.added.clone(),
        set: round.set.clone(),
        reason: round.reason.clone(),
        suspects: round
            .candidates
            .iter()
            .map(|suspect| SuspectOutput {
                id: suspect.effect.id.clone(),
                p_value: suspect.p_value(),
                statistic: suspect.statistic(),
                absorbed: suspect.score.as_ref().map(|score| score.absorbed),
                parameters: diagnosis
                    .sizes
                    .get(at)
                    .into_iter()
                    .flatten()
                    .find(|own| own.id == suspect.effect.id)
                    .map(|own| own.parameters.iter().map(parameter).collect()),
                ln_evidence: round
                    .refits
                    .iter()
                    .find(|refit| refit.id == suspect.effect.id)
                    .map(|refit| round.nats(refit.log_evidence)),
            })
            .collect(),
    };
    diagnosis.rounds.iter().enumerate().map(round).collect()
}
