//! Parameters that would have to wander, before and after.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, table as tables};
use crate::report::table::markup;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "wander",
    title: "Parameters that would have to wander",
    render,
};

fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let before = diagnosis.before.as_ref()?;
    if diagnosis.wander.is_empty() {
        return None;
    }
    let of = |fit, wander, title| tables::wander(subject, (fit, wander, title));
    let first = of(before, &diagnosis.wander, "The recalibrated model");
    let after = diagnosis.after.as_ref();
    let after = after.filter(|_| !diagnosis.wander_after.is_empty());
    Some(html! {
        p {
            "A parameter of the machine is the same at every crank angle and at every speed. One that would \
             have to change from part to part makes up for something that the model lacks."
        }
        @match &first {
            Some(table) => (markup(table)),
            None => p { "With the recalibrated model none would have to, within the scatter between cycles." },
        }
        @if let Some(after) = after {
            @match of(after, &diagnosis.wander_after, "With the answer") {
                Some(table) => (markup(&table)),
                None => p { "With the answer none would have to, within the scatter between cycles." },
            }
        }
    })
}
