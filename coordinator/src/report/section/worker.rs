//! Who computed, and how busy they were.
use super::{Rendered, Section, Subject, figure};
use crate::{
    account,
    report::{chart, table},
};
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
    Ok((!calibration.workers.is_empty()).then(|| {
        html! {
            @if let Some(drawn) = &drawn { (figure(drawn)) }
            (table::markup(&table::slot_time(&calibration.spent)))
            ul { @for reason in account::reasons(&calibration.spent) { li { (reason) } } }
            (table::markup(&table::workers(&calibration.workers)))
        }
    }))
}
