//! Who computed, and how busy they were.
use crate::data::Calibration;
use crate::document::{Block, Section, figures};
use crate::{chart, table};
use dispatch::account;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    if !calibration.workers.is_empty() {
        blocks.extend(figures(chart::workers(&calibration.workers)));
        blocks.extend([
            Block::Table(table::slot_time(&calibration.spent)),
            Block::List(account::reasons(&calibration.spent)),
            Block::Table(table::workers(&calibration.workers)),
        ]);
    }
    Section {
        id: "workers",
        title: "Use of the workers",
        blocks,
    }
}
