//! What was found, as entries of a model file.
use super::Subject;
use crate::case::{CaseEffect, CaseParameter, Provenance, write_effects};
use discrepancy::diagnose::Estimate;

/// `[[effects]]` tables of the added effects, with intervals and where they come from, as a case file
/// takes them; nothing if no effect was added.
pub fn effects_toml(subject: &Subject<'_>) -> Option<String> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let found = (1..).zip(&diagnosis.rounds).filter_map(|(number, round)| {
        let id = round.added.as_ref()?;
        let found = diagnosis.effects.iter().find(|effect| effect.id == *id)?;
        Some(entry(subject, found, (number, &round.set)))
    });
    let effects: Vec<CaseEffect> = found.collect();
    (!effects.is_empty()).then(|| write_effects(&effects))
}

fn entry(subject: &Subject<'_>, found: &Estimate, (round, set): (u32, &[String])) -> CaseEffect {
    let parameters = found.parameters.iter().map(|(name, unit, value, ci95)| {
        let [low, high] = *ci95;
        let parameter = CaseParameter {
            value: *value,
            unit: unit.clone(),
            // a value at its bound has no interval around it
            ci95: (low.is_finite() && high.is_finite() && (low..=high).contains(value))
                .then_some(*ci95),
        };
        (name.clone(), parameter)
    });
    let verdict = if set.len() > 1 { "ambiguous" } else { "named" };
    CaseEffect {
        id: found.id.clone(),
        parameters: parameters.collect(),
        provenance: Some(Provenance {
            dataset: Some(subject.provenance.case_hash.clone()),
            run: Some(subject.provenance.run.clone()),
            verdict: Some(verdict.to_owned()),
            set: set.to_vec(),
            ln_evidence_gain: found.ln_evidence.is_finite().then_some(found.ln_evidence),
            round: Some(round),
        }),
    }
}
