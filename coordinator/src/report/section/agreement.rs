//! Measured against simulated stress, gauge by gauge, condition by condition.
use super::{Rendered, Section, Subject, figure};
use crate::report::chart;
use crate::report::words::condition_name;
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "overlays",
    title: "Measured and simulated stress",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let Subject::Calibration(calibration) = subject else {
        return Ok(None);
    };
    let case = &calibration.case;
    let mut parts = Vec::new();
    for result in &calibration.conditions {
        let figures = chart::overlays(case, result)?;
        if figures.is_empty() {
            continue;
        }
        parts.push(html! {
            h3 { "Condition " (condition_name(case, result.condition)) }
            @for overlay in &figures { (figure(overlay)) }
        });
    }
    Ok((!parts.is_empty()).then(|| {
        html! {
            p { "Fitted points first, then the others of the record." }
            @for part in parts { (part) }
        }
    }))
}
