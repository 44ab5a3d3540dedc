//! Where simulation and measurement still disagree.
use crate::report::data::Calibration;
use crate::report::document::{Section, tables};
use crate::report::table;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let results = calibration.conditions.iter();
    Section {
        id: "gap",
        title: "Where the gap remains",
        blocks: tables(results.filter_map(|result| table::gap(&calibration.case, result))),
    }
}
