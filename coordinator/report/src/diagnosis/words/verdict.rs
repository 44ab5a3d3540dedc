//! Verdict of a diagnosis as a keyword and as a sentence.
use super::effect::{generic, named};
use crate::diagnosis::subject::DiagnosisInput;
use crate::number::percent;
use crate::words::join_words;
use discrepancy::diagnose::{Diagnosis, Round};
use discrepancy::verdict::Verdict;

/// Returns the verdict's keyword in capitals.
pub(in crate::diagnosis) fn outcome(diagnosis: &Diagnosis) -> &'static str {
    match (diagnosis.verdict, diagnosis.is_in_part()) {
        (Verdict::NothingDetected, _) => "NOTHING DETECTED",
        (Verdict::Named, false) => "NAMED",
        (Verdict::Named, true) => "NAMED IN PART",
        (Verdict::Ambiguous, false) => "AMBIGUOUS",
        (Verdict::Ambiguous, true) => "AMBIGUOUS IN PART",
        (Verdict::Unlisted, false) => "UNLISTED",
        (Verdict::Unlisted, true) => "UNLISTED IN PART",
        (Verdict::Unresolved, _) => "UNRESOLVED",
    }
}

/// Returns the verdict as one sentence, without the effect sizes: what is missing, and how much of the gap it
/// explains and leaves.
pub(in crate::diagnosis) fn verdict(subject: &DiagnosisInput<'_>) -> String {
    let diagnosis = subject.diagnosis();
    let said = claim(subject);
    if diagnosis.is_in_part() {
        let what = diagnosis.reason.as_deref().unwrap_or_default();
        let taken = taken(diagnosis).map_or_else(String::new, |taken| format!("; {taken}"));
        return format!("In part: {}; it {what}{taken}.", said.trim_end_matches('.'));
    }
    match diagnosis.remainder.explained {
        Some(share) if diagnosis.verdict != Verdict::Unresolved => {
            let taken = taken(diagnosis).map_or_else(String::new, |taken| format!(", {taken}"));
            format!(
                "{}; it explains {} of the gap{taken}, and no more than noise is left.",
                said.trim_end_matches('.'),
                percent(share)
            )
        }
        _ => taken(diagnosis).map_or_else(
            || said.clone(),
            |taken| format!("{}; {taken}.", said.trim_end_matches('.')),
        ),
    }
}

/// Returns how much of the gap a smooth discrepancy takes beside the model of the answer; `None` without one.
fn taken(diagnosis: &Diagnosis) -> Option<String> {
    let own = diagnosis.remainder.discrepancy.as_ref()?;
    let share = percent(own.share);
    Some(format!(
        "a smooth discrepancy without a cause takes {share} of the gap"
    ))
}

/// Returns what the verdict claims, as one sentence.
fn claim(subject: &DiagnosisInput<'_>) -> String {
    let diagnosis = subject.diagnosis();
    match diagnosis.verdict {
        Verdict::NothingDetected if diagnosis.limits.is_empty() => {
            "Nothing detected: what the recalibrated simulation leaves of the record is noise; no \
             effect was looked for by name."
                .to_owned()
        }
        Verdict::NothingDetected => {
            let traces = diagnosis.traces().into_iter();
            let traces: Vec<String> = traces.map(|(own, _)| named(subject, &own.id)).collect();
            let trace = if traces.is_empty() {
                String::new()
            } else {
                format!(" and a trace of {}", join_words(&traces, "and"))
            };
            format!(
                "Nothing detected: what the recalibrated simulation leaves of the record is noise{trace}, down to the \
                 detection limits below."
            )
        }
        Verdict::Named => {
            let added = subject.added().into_iter();
            let names: Vec<String> = added.map(|effect| named(subject, &effect.id)).collect();
            format!("The simulation lacks {}.", join_words(&names, "and"))
        }
        Verdict::Ambiguous => format!(
            "The simulation lacks {}; this record does not tell which.",
            join_words(&choices(subject), "and")
        ),
        Verdict::Unlisted => format!(
            "The simulation lacks something that the library does not have; it acts like {}.",
            diagnosis.generic.as_deref().map_or_else(
                || "a force of unknown form".to_owned(),
                |id| generic(subject, id)
            )
        ),
        Verdict::Unresolved => {
            "Unresolved: this record is not sufficient to name an effect.".to_owned()
        }
    }
}

/// Lists the effects added by a diagnosis, round by round: an effect's name, or the members of an ambiguity
/// set joined by "or".
fn choices(subject: &DiagnosisInput<'_>) -> Vec<String> {
    let rounds = subject.diagnosis().rounds.iter();
    let choice = |round: &Round| {
        let members: Vec<String> = round.set.iter().map(|id| named(subject, id)).collect();
        let of = if members.len() > 1 { "one of " } else { "" };
        format!("{of}{}", join_words(&members, "or"))
    };
    let found = rounds.filter(|round| round.added.is_some());
    found.map(choice).collect()
}
