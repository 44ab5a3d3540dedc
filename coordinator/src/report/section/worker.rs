//! Who computed, and how busy they were.
use super::{Rendered, Section, Subject, figure};
use crate::report::{chart, table};
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "workers",
    title: "Use of the workers",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let Subject::Calibration(calibration) = subject else {
        return Ok(None);
    };
    let drawn = chart::workers(&calibration.workers)?;
    Ok(drawn.map(|drawn| {
        html! {
            (figure(&drawn))
            (table::markup(&table::workers(&calibration.workers)))
        }
    }))
}
