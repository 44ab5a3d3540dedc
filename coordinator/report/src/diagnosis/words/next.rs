//! Sentences that recommend the next steps after a diagnosis.
use crate::diagnosis::subject::DiagnosisInput;
use crate::number::percent;
use crate::words::{command, join_words};
use discrepancy::diagnose::Diagnosis;
use discrepancy::verdict::Verdict;
use record::noise::NoiseSource;

/// Lists the recommended next steps, one sentence each.
pub(in crate::diagnosis) fn next(subject: &DiagnosisInput<'_>) -> Vec<String> {
    let diagnosis = subject.diagnosis();
    let mut steps = vec![by_verdict(diagnosis)];
    if !diagnosis.noise.is_seen() {
        steps.push("Record several cycles: five show the scatter, ten show it well.".to_owned());
    }
    let missing = missing_channels(subject);
    if !missing.is_empty() && diagnosis.verdict != Verdict::NothingDetected {
        steps.push(format!(
            "Record {} too: the more places a record has, the fewer effects look alike in it.",
            join_words(&missing, "and")
        ));
    }
    if diagnosis.verdict == Verdict::Unresolved
        && let Some(hidden) = diagnosis.absorbed.first()
    {
        steps.push(format!(
            "Consider what this record cannot show, {} above all: {} of it is taken up by the unknowns. It \
             would show with {}.",
            hidden.id,
            percent(hidden.share),
            hidden.measurement
        ));
    }
    if subject.diagnosed.records.len() < 2 {
        steps.push(
            "Record a second speed or another load: nothing here was shown on a condition that took \
             no part."
                .to_owned(),
        );
    }
    steps
}

fn by_verdict(diagnosis: &Diagnosis) -> String {
    let step = match diagnosis.verdict {
        Verdict::Named => {
            "Look at that part of the machine. The entry below, appended to case.toml (or the same \
             command with --add), makes the effect ordinary physics: every simulation has it, and a \
             calibration fits the parameters beside it."
        }
        Verdict::Ambiguous => {
            "Look at the members of the set on the machine, or take a record that tells them apart. \
             The best of them stands in the entry below; its size is right only if its name is."
        }
        Verdict::Unlisted => {
            "Look for the cause where that force acts, and write a law for it: an effect is one file \
             of the simulation. The form of the force is a hint at the law, not the law."
        }
        Verdict::NothingDetected => {
            "Believe the recalibrated model as far as the detection limits go; a smaller effect needs \
             more cycles or less noise in the measurement."
        }
        Verdict::Unresolved => return unresolved(diagnosis),
    };
    step.to_owned()
}

fn unresolved(diagnosis: &Diagnosis) -> String {
    if diagnosis.before.is_none() {
        format!(
            "See that the case simulates at all (`{}`) and that its record is complete (`{}`).",
            command::SIMULATE,
            command::CHECK
        )
    } else if diagnosis.noise == NoiseSource::Estimated {
        "State `noise` for every channel in case.toml, or record several cycles: no effect is named on guessed noise."
            .to_owned()
    } else if diagnosis.rounds.is_empty() {
        format!(
            "Calibrate first (`{}`) and diagnose that run: tests mean nothing at a point that is not \
             a minimum.",
            command::CALIBRATE
        )
    } else {
        "More cycles, or a record of another speed: the likeliest suspects below say what to look for."
            .to_owned()
    }
}

/// Returns the titles of the channels that the case defines for the condition but the record lacks.
fn missing_channels(subject: &DiagnosisInput<'_>) -> Vec<String> {
    let Some(record) = subject.calibrated() else {
        return Vec::new();
    };
    let has = |name: &str| record.channels.iter().any(|own| own.channel.name == name);
    let all = subject.case.channels_of(record.condition);
    all.filter(|(_, channel)| !has(&channel.name))
        .map(|(_, channel)| channel.title.clone())
        .collect()
}
