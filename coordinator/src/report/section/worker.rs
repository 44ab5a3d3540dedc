//! Who computed, and how busy they were.
use crate::account;
use crate::report::data::Calibration;
use crate::report::document::{Block, Section, figures};
use crate::report::{chart, table};

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
