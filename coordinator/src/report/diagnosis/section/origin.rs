//! How the diagnosis was made: enough to make it again.
use super::{Figures, Section};
use crate::report::diagnosis::Subject;
use crate::report::number::duration;
use crate::report::section::provenance;
use crate::report::words::condition_name;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "provenance",
    title: "How it was made",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let named = subject
        .library
        .iter()
        .filter(|effect| !effect.generic)
        .count();
    Some(html! {
        dl.facts {
            (provenance::origin(&subject.provenance, subject.case))
            @for record in subject.records {
                dt { "record of " (condition_name(subject.case, record.condition)) }
                dd {
                    (record.cycles.len()) " cycles of "
                    (record.channels.iter().map(|c| c.name()).collect::<Vec<_>>().join(", "))
                }
            }
            dt { "library" }
            dd {
                (named) " named effects, " (subject.library.len() - named)
                " forces without a cause"
            }
            dt { "wall time" } dd { (duration(subject.wall_s)) }
            @if !subject.provenance.digest.is_empty() {
                dt { "digest of the result" } dd { code { (subject.provenance.digest) } }
            }
        }
    })
}
