//! Where simulation and measurement still disagree.
use crate::data::Calibration;
use crate::document::{Section, tables};
use crate::table;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let results = calibration.conditions.iter();
    Section {
        id: "gap",
        title: "Where the gap remains",
        blocks: tables(results.filter_map(|result| table::gap(&calibration.case, result))),
    }
}
