//! The proof: how far the gap closes, on records that took part and on records that did not, with
//! the best rejected rival beside it.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, table as tables};
use crate::report::section::figure;
use crate::report::table::markup;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "show",
    title: "What it shows",
    render,
};

fn render(subject: &Subject<'_>, figures: &Figures) -> Option<Markup> {
    let gaps = tables::gaps(subject);
    if gaps.is_none() && figures.proof.is_empty() {
        return None;
    }
    let added = subject
        .diagnosed
        .diagnosis
        .rounds
        .iter()
        .any(|round| round.added.is_some());
    Some(html! {
        @if !added {
            p { "Nothing was added: before and after are the same model, shown for what it leaves." }
        }
        @if let Some(gaps) = &gaps { (markup(gaps)) }
        @if let Some(paper) = tables::paper(subject) { (markup(&paper)) }
        @for proof in &figures.proof {
            h3 { "Condition " (proof.condition) }
            @for one in &proof.gauges { (figure(one)) }
            @if !proof.others.is_empty() {
                details {
                    summary { "Other channels" }
                    @for one in &proof.others { (figure(one)) }
                }
            }
        }
    })
}
