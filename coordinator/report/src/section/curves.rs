//! Report section with the curves of one simulation: its channels, and figures specific to its kind of model.
use crate::data::{Calibration, SingleRun};
use crate::document::{Block, Section, figures};
use crate::kind;
use maud::html;

/// Builds the curves section of a calibration report: figures specific to the kind of model with the
/// optimised parameters, without the channels, which another section shows.
pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    if let Some(optimum) = calibration.optimum() {
        blocks.extend(figures(kind::of(optimum.case).figures(&optimum)));
    }
    if !blocks.is_empty() {
        let whose = html! { p { "With the optimised parameters, calibrated condition." } };
        blocks.insert(0, Block::Markup(whose));
    }
    section(blocks)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let (kind, shown) = (kind::of(&run.case), run.shown());
    let channels = kind.channels(&shown).into_iter();
    section(figures(channels.chain(kind.figures(&shown))))
}

const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "curves",
        title: "Simulated curves",
        blocks,
    }
}
