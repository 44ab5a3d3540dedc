//! The curves of one simulation.
use super::{Rendered, Section, Subject, figure};
use crate::report::chart;
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "curves",
    title: "Curves over the revolution",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let figures = match subject {
        Subject::Single(run) => chart::simulation(&run.case, run.condition, &run.simulation)?,
        Subject::Calibration(calibration) => match calibration.calibrated() {
            // the overlays show the gauges already
            Some(result) => chart::machine_curves(
                &calibration.case,
                result.condition,
                &result.optimised.simulation,
            )?,
            None => Vec::new(),
        },
    };
    let whose = matches!(subject, Subject::Calibration(_));
    Ok((!figures.is_empty()).then(|| {
        html! {
            @if whose { p { "With the optimised parameters, calibrated condition." } }
            @for one in &figures { (figure(one)) }
        }
    }))
}
