//! What is added to the model: the entry of the case file, and its sizes.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, effects_toml, table as tables};
use crate::report::table::markup;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "add",
    title: "What is added",
    render,
};

fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let sizes = tables::sizes(subject);
    let entry = effects_toml(subject);
    if sizes.is_none() && entry.is_none() {
        return None;
    }
    Some(html! {
        @if let Some(sizes) = &sizes { (markup(sizes)) }
        @if let Some(entry) = &entry {
            p {
                "The same as an entry of the case's model file. Without it the model is what it was, to \
                 the bit; with it the effect is ordinary physics, simulated by every worker and fitted \
                 like any gene:"
            }
            pre { code { (entry) } }
        }
    })
}
