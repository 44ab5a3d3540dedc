//! The gap before and after.
use discrepancy::proof::{closed::Closed, compare::Row};
use serde::Serialize;

/// The gap of the answer.
#[derive(Debug, Default, Serialize)]
pub(super) struct GapOutput {
    calibration: Option<Closed>,
    held_out: Option<Closed>,
    other_condition: Option<Closed>,
}

/// The gap of an answer by its rows; `calibrated` is the condition that was fitted.
pub(super) fn gap(rows: &[Row], calibrated: usize) -> GapOutput {
    let one = |fitted: bool, own: bool| {
        let row = rows
            .iter()
            .find(|row| row.fitted == fitted && (row.condition == calibrated) == own)?;
        Some(row.closed)
    };
    GapOutput {
        calibration: one(true, true),
        held_out: one(false, true),
        other_condition: one(false, false),
    }
}
