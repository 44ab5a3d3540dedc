//! The machine in motion, with the parameters the report is about.
use crate::report::animation;
use crate::report::data::{Calibration, SingleRun};
use crate::report::document::{Block, Section};
use maud::{Markup, html};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let moving = calibration.calibrated().and_then(|result| {
        let simulation = &result.optimised.simulation;
        animation::machine(&calibration.case, result.condition, simulation)
    });
    section("the optimised", moving)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let moving = animation::machine(&run.case, run.condition, &run.simulation);
    section(&run.genes_name, moving)
}

fn section(whose: &str, machine: Option<Markup>) -> Section {
    let shown = machine.map(|machine| {
        Block::Markup(html! {
            p {
                "Side view with " (whose) " parameters. The well is on the right; the drawing \
                 moves where JavaScript is allowed."
            }
            (machine)
        })
    });
    Section {
        id: "moving-machine",
        title: "The machine in motion",
        blocks: shown.into_iter().collect(),
    }
}
