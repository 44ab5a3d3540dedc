//! Effects found by a diagnosis, as entries of a case file.
use super::subject::DiagnosisInput;
use case::{CaseEffect, CaseParameter, Provenance, write_effects};
use discrepancy::diagnose::Estimate;
use discrepancy::model::bounds;
use protocol::announce::ParameterDescriptor;

/// Returns the `[[effects]]` tables of the added effects for a case file, with intervals and provenance;
/// `None` if no effect was added.
pub fn effects_toml(subject: &DiagnosisInput<'_>) -> Option<String> {
    let effects = effects(subject);
    (!effects.is_empty()).then(|| write_effects(&effects))
}

/// Returns the added effects with intervals and provenance; effects that switch on an unknown of the case are
/// excluded (see [`starts`]).
pub fn effects(subject: &DiagnosisInput<'_>) -> Vec<CaseEffect> {
    let diagnosis = subject.diagnosis();
    let found = (1..).zip(&diagnosis.rounds).filter_map(|(number, round)| {
        let id = round.added.as_ref()?;
        let found = diagnosis.effects.iter().find(|effect| effect.id == *id)?;
        let effect = found.unknowns.is_empty();
        effect.then(|| entry(subject, found, number, &round.set))
    });
    found.collect()
}

/// Returns the unknowns of the case that the diagnosis switched on, with their start values for a
/// calibration.
pub fn starts(subject: &DiagnosisInput<'_>) -> Vec<(String, f64)> {
    let found = subject.diagnosis().effects.iter();
    let each = found.flat_map(|one| one.unknowns.iter().zip(&one.parameters));
    let named = each.filter_map(|(position, parameter)| {
        let unknown = subject.case.unknowns.get(*position)?;
        Some((unknown.name.clone(), parameter.value))
    });
    named.collect()
}

fn entry(subject: &DiagnosisInput<'_>, found: &Estimate, round: u32, set: &[String]) -> CaseEffect {
    let descriptor = subject
        .diagnosed
        .result
        .library
        .iter()
        .find(|effect| effect.id == found.id);
    let parameters = found.parameters.iter().map(|own| {
        let (value, [low, high]) = (own.value, own.interval);
        // a value at its bound has no interval around it
        let ci95 = (low.is_finite() && high.is_finite() && (low..=high).contains(&value))
            .then_some(own.interval);
        let mut known = descriptor.iter().flat_map(|effect| &effect.parameters);
        let known = known.find(|p| p.name == own.name);
        let parameter = CaseParameter {
            value,
            unit: own.unit.clone(),
            ci95,
            search: ci95
                .zip(known)
                .and_then(|(ci95, known)| search(value, ci95, known)),
        };
        (own.name.clone(), parameter)
    });
    let verdict = if set.len() > 1 { "ambiguous" } else { "named" };
    CaseEffect {
        id: found.id.clone(),
        parameters: parameters.collect(),
        provenance: Some(Provenance {
            dataset: Some(subject.origin.case_hash.clone()),
            run: Some(subject.origin.run.clone()),
            verdict: Some(verdict.to_owned()),
            set: set.to_vec(),
            ln_evidence_gain: found.ln_evidence.is_finite().then_some(found.ln_evidence),
            round: Some(round),
        }),
    }
}

/// Ratio of the half-width of the calibration's search interval to that of the parameter's 95 % interval. The
/// search interval extends at least by `SHARE` of the distance to the parameter's value without the effect,
/// since the 95 % interval holds only for the channels and discretisation of the diagnosis.
const REACH: f64 = 5.0;
const SHARE: f64 = 0.25;

/// Returns the interval in which a calibration searches an effect's parameter; `None` if the bounds leave no
/// room. Called only for parameters whose size the records determine.
fn search(value: f64, [low, high]: [f64; 2], of: &ParameterDescriptor) -> Option<[f64; 2]> {
    let half = (high - value).max(value - low);
    let reach = (REACH * half).max(SHARE * (value - of.absent).abs());
    // back and forth between units a bound loses its last digit, and the model refuses what lies beyond
    let unscaled = |scaled: f64| (of.absent + scaled * of.scale).clamp(of.lower, of.upper);
    let [least, most] = bounds(of).map(unscaled);
    let interval @ [from, to] = [(value - reach).max(least), (value + reach).min(most)];
    (from < to && (from..=to).contains(&value)).then_some(interval)
}

#[cfg(test)]
mod tests {
    use super::search;
    use protocol::announce::{ParameterDescriptor, Role, Sign};

    #[test]
    fn what_was_found_is_searched_within_the_bounds_of_the_effect() {
        let friction = ParameterDescriptor {
            name: "moment".to_owned(),
            unit: "N.m".to_owned(),
            role: Role::Size,
            sign: Sign::Positive,
            lower: -2000.0,
            upper: 2000.0,
            absent: 0.0,
            typical: 500.0,
            scale: 500.0,
        };
        let at = |value: f64, half: f64| search(value, [value - half, value + half], &friction);
        assert_eq!(at(1000.0, 60.0), Some([700.0, 1300.0]));
        // a narrow interval does not say that the model is that good
        assert_eq!(at(1000.0, 1.0), Some([750.0, 1250.0]));
        // friction does not drive, and no more than the model takes
        assert_eq!(at(1000.0, 400.0), Some([0.0, 2000.0]));
        assert_eq!(at(0.0, 0.0), None);
        // the part of an interval that its bound leaves
        assert_eq!(
            search(1900.0, [1800.0, 2000.0], &friction),
            Some([1400.0, 2000.0])
        );
        // nor by the last digit that a change of units costs
        let speed = ParameterDescriptor {
            role: Role::Shape,
            sign: Sign::Either,
            lower: 0.002,
            upper: 0.3,
            absent: 0.02,
            typical: 0.02,
            scale: 0.05,
            ..friction
        };
        let [lowest, _] = search(0.01, [0.004, 0.016], &speed).unwrap();
        assert_eq!(lowest.to_bits(), 0.002_f64.to_bits());
    }
}
