//! The machine in motion, with the parameters the report is about.
use crate::report::data::{Calibration, Shown, SingleRun};
use crate::report::document::{Block, Section};
use crate::report::kind;
use maud::{Markup, html};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let optimum = calibration.optimum();
    section(
        "the optimised",
        optimum.and_then(|optimum| moving(&optimum)),
    )
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    section(&run.genes_name, moving(&run.shown()))
}

fn moving(shown: &Shown<'_>) -> Option<Markup> {
    kind::of(shown.case)?.moving(shown)
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
