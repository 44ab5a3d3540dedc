//! Data behind the figures and tables of a diagnosis, as CSV.
//!
//! An empty field is a missing value; numbers are written with all their digits.
use super::condition_curves::condition_curves;
use super::judgement::{judge, ranked};
use super::subject::DiagnosisInput;
use crate::number::field;
use std::io::Write;

const CURVES: [&str; 9] = [
    "condition",
    "channel",
    "unit",
    "at",
    "measured",
    "spread",
    "before",
    "after",
    "rival",
];

/// Writes the measured and simulated curves of a diagnosis as CSV: one row per condition, channel and point;
/// absolute values in the channel's unit.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn curves(to: impl Write, subject: &DiagnosisInput<'_>) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(CURVES)?;
    for shown in condition_curves(subject) {
        for c in 0..shown.record.channels.len() {
            let Some(of) = shown.channel(c) else {
                continue;
            };
            for (i, &at_point) in of.at.iter().enumerate() {
                let at = |values: Option<&[f64]>| field(values.and_then(|v| v.get(i).copied()));
                writer.write_record([
                    of.condition.to_owned(),
                    of.channel.to_owned(),
                    of.unit.to_owned(),
                    field(Some(at_point)),
                    at(Some(of.measured)),
                    at(Some(of.spread)),
                    at(Some(of.before)),
                    at(of.after),
                    at(of.rival.map(|(_, values)| values)),
                ])?;
            }
        }
    }
    Ok(writer.flush()?)
}

const SUSPECTS: [&str; 11] = [
    "round",
    "effect",
    "title",
    "joint",
    "generic",
    "p_value",
    "statistic",
    "absorbed",
    "ln_evidence",
    "kept",
    "why",
];

/// Writes the candidate effects of every round, including generic forces, each with its judgement.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn suspects(to: impl Write, subject: &DiagnosisInput<'_>) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(SUSPECTS)?;
    for (number, round) in (1..).zip(&subject.diagnosis().rounds) {
        let generics = round
            .generics
            .iter()
            .map(|force| (force, judge(round, force)));
        for (suspect, judgement) in ranked(round).into_iter().chain(generics) {
            let effect = &suspect.effect;
            // a force without a cause is never a name: what is said of names does not hold for it
            let why = if effect.generic {
                String::new()
            } else {
                judgement.why
            };
            writer.write_record([
                number.to_string(),
                effect.id.clone(),
                effect.title.clone(),
                effect.joint.clone(),
                effect.generic.to_string(),
                field(judgement.p_value),
                field(suspect.score.as_ref().map(|score| score.statistic)),
                field(suspect.score.as_ref().map(|score| score.absorbed)),
                field(judgement.gain),
                judgement.kept.to_string(),
                why,
            ])?;
        }
    }
    Ok(writer.flush()?)
}
