//! Where the search looked, between the bounds of every gene.
use crate::report::chart;
use crate::report::data::Calibration;
use crate::report::document::{Section, figures};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let searched = !calibration.history.is_empty();
    Section {
        id: "genes",
        title: "Genes between their bounds",
        blocks: figures(searched.then(|| chart::genes(calibration))),
    }
}
