//! The curves of one simulation: its channels, and what its kind of model shows beside them.
use crate::report::data::{Calibration, SingleRun};
use crate::report::document::{Block, Section, figures};
use crate::report::kind;
use maud::html;

/// With the optimised parameters; their channels are in the overlays.
pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    if let (Some(kind), Some(optimum)) = (kind::of(&calibration.case), calibration.optimum()) {
        let whose = html! { p { "With the optimised parameters, calibrated condition." } };
        blocks.push(Block::Markup(whose));
        blocks.extend(figures(kind.figures(&optimum)));
    }
    section(blocks)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let shown = kind::of(&run.case).map(|kind| {
        let channels = kind.channels(&run.shown());
        std::iter::once(channels).chain(kind.figures(&run.shown()))
    });
    section(figures(shown.into_iter().flatten()))
}

const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "curves",
        title: "Curves over the revolution",
        blocks,
    }
}
