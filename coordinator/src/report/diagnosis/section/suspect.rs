//! What was suspected: every effect with its test, its refit, and why it was dropped or kept.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, table as tables, words};
use crate::report::table::markup;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "what",
    title: "What was suspected",
    render,
};

fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let first = diagnosis.rounds.first()?;
    Some(html! {
        p {
            "Each effect of the library was switched on at the recalibrated point, its signature \
             projected off what recalibration can absorb, and tested on what the model leaves; the \
             likeliest were then fitted for real, with every gene free."
        }
        @for (number, round) in (1..).zip(&diagnosis.rounds) {
            (markup(&tables::suspects(number, round)))
            @if let Some(reason) = &round.reason { p { "No effect of this round is in the answer: " (reason) "." } }
        }
        @if let Some(generics) = tables::generics(first) { (markup(&generics)) }
        @if let Some(id) = &diagnosis.generic {
            p { "The widest margin has " (words::generic(subject, id)) ": no name comes near it." }
        } @else if let Some(force) = &diagnosis.force {
            p {
                "The widest margin has " (words::generic(subject, &force.id))
                ", and it is only suspected."
            }
        }
        @if let Some(pairs) = tables::look_alikes(subject) { (markup(&pairs)) }
        @if let Some(limits) = tables::limits(subject) {
            details {
                summary { "Detection limits of all effects" }
                (markup(&limits))
            }
        }
    })
}
