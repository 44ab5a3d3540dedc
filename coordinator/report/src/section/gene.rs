//! Where the search looked, between the bounds of every gene.
use crate::chart;
use crate::data::Calibration;
use crate::document::{Section, figures};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let searched = !calibration.history.is_empty();
    Section {
        id: "genes",
        title: "Genes between their bounds",
        blocks: figures(searched.then(|| chart::genes(calibration))),
    }
}
