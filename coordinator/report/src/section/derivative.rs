//! What each unknown changes.
use crate::chart;
use crate::data::SingleRun;
use crate::document::{Block, Section, figures};
use crate::{kind, table};

pub(super) fn simulation(run: &SingleRun) -> Section {
    let mut blocks: Vec<Block> = table::derivatives(run)
        .map(Block::Table)
        .into_iter()
        .collect();
    let zero = kind::of(&run.case).zero();
    blocks.extend(figures(chart::derivatives(run, zero)));
    Section {
        id: "derivatives",
        title: "Derivatives",
        blocks,
    }
}
