//! The machine in motion, with the parameters the report is about.
use super::{Rendered, Section, Subject};
use crate::report::animation;
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "moving-machine",
    title: "The machine in motion",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let (case, condition, simulation, whose) = match subject {
        Subject::Calibration(calibration) => match calibration.calibrated() {
            Some(result) => (
                &calibration.case,
                result.condition,
                &result.optimised.simulation,
                "the optimised",
            ),
            None => return Ok(None),
        },
        Subject::Single(run) => (
            &run.case,
            run.condition,
            &run.simulation,
            run.genes_name.as_str(),
        ),
    };
    let machine = animation::machine(case, condition, simulation)?;
    Ok(machine.map(|machine| {
        html! {
            p {
                "Side view with " (whose) " parameters. The well is on the right; the drawing \
                 moves where JavaScript is allowed."
            }
            (machine)
        }
    }))
}
