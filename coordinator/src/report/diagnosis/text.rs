//! The answer as plain text, for a terminal and for `tables.txt`.
use super::Subject;
use super::{table as tables, words};
use crate::report::table;
use discrepancy::verdict::Verdict;

/// The whole answer: verdict, grounds, next steps, tables.
pub fn text(subject: &Subject<'_>) -> String {
    let diagnosis = &subject.diagnosed.diagnosis;
    let mut text = format!(
        "{}\n{}\n",
        headline(diagnosis.verdict),
        words::verdict(subject)
    );
    if let Some(reason) = &diagnosis.reason {
        item(&mut text, &format!("The reason: {reason}."));
    }
    for (label, sizes) in words::effects(subject) {
        item(&mut text, &format!("{label}: {sizes}"));
    }
    for sentence in words::confidence(subject) {
        item(&mut text, &sentence);
    }
    if diagnosis.verdict == Verdict::NothingDetected
        && let Some(sentence) = words::reach(subject)
    {
        item(&mut text, &sentence);
    }
    for sentence in words::next(subject) {
        item(&mut text, &format!("Next: {sentence}"));
    }
    for note in diagnosis.notes.iter().chain(subject.notes) {
        item(&mut text, &format!("Note: {note}"));
    }
    let rounds = (1..).zip(&diagnosis.rounds);
    let suspects = rounds.map(|(number, round)| tables::suspects(number, round));
    let tables = tables::gaps(subject)
        .into_iter()
        .chain(tables::paper(subject))
        .chain(tables::sizes(subject))
        .chain(suspects)
        .chain(diagnosis.rounds.first().and_then(tables::generics))
        .chain(tables::look_alikes(subject))
        .chain(tables::limits(subject))
        .chain(tables::numerics(subject))
        .chain(tables::genes(subject))
        .chain(tables::stages(subject));
    for each in tables {
        text.push('\n');
        text.push_str(&table::text(&each, false));
    }
    text
}

/// The verdict's name.
pub(super) const fn headline(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingDetected => "NOTHING DETECTED",
        Verdict::Named => "NAMED",
        Verdict::Ambiguous => "AMBIGUOUS",
        Verdict::Unlisted => "UNLISTED",
        Verdict::Unresolved => "UNRESOLVED",
    }
}

fn item(text: &mut String, sentence: &str) {
    text.push_str("  - ");
    text.push_str(sentence);
    text.push('\n');
}
