//! Report section with the notes and warnings of the run.
use crate::data::{Calibration, SingleRun};
use crate::document::{Block, Section};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    section(&calibration.notes)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    section(&run.notes)
}

fn section(notes: &[String]) -> Section {
    let list = (!notes.is_empty()).then(|| Block::List(notes.to_vec()));
    Section {
        id: "notes",
        title: "Notes",
        blocks: list.into_iter().collect(),
    }
}
