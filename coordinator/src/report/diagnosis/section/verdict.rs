//! The verdict: one sentence, its size, how sure it is, and what to do next.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, words};
use crate::report::words::SYNTHETIC;
use discrepancy::verdict::Verdict;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "verdict",
    title: "Verdict",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let grounds = words::confidence(subject);
    let reach = match diagnosis.verdict {
        Verdict::NothingDetected | Verdict::Unresolved => words::reach(subject),
        Verdict::Named | Verdict::Ambiguous | Verdict::Unlisted => None,
    };
    Some(html! {
        p.verdict { (words::verdict(subject)) }
        @if let Some(reason) = &diagnosis.reason { p { "The reason: " (reason) "." } }
        @if !diagnosis.effects.is_empty() {
            ul {
                @for (label, sizes) in words::effects(subject) {
                    li { b { (label) } ": " (sizes) }
                }
            }
        }
        @if !grounds.is_empty() {
            h3 { "How sure" }
            ul.ground { @for ground in &grounds { li { (ground) } } }
        }
        @if let Some(reach) = reach { p { (reach) } }
        h3 { "What to do next" }
        ul.ground { @for step in words::next(subject) { li { (step) } } }
        @if subject.provenance.synthetic { p { (SYNTHETIC) } }
        @if !diagnosis.notes.is_empty() || !subject.notes.is_empty() {
            div.warning {
                @for note in diagnosis.notes.iter().chain(subject.notes) { p { (note) } }
            }
        }
    })
}
