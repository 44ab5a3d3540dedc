//! Where simulation and measurement still disagree.
use super::{Rendered, Section, Subject};
use crate::report::table;
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "gap",
    title: "Where the gap remains",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: Subject<'_>) -> Rendered {
    let Subject::Calibration(calibration) = subject else {
        return Ok(None);
    };
    let tables: Vec<_> = calibration
        .conditions
        .iter()
        .filter_map(|result| table::gap(&calibration.case, result))
        .collect();
    if tables.is_empty() {
        return Ok(None);
    }
    Ok(Some(html! {
        @for each in &tables { (table::markup(each)) }
    }))
}
