//! The gap before and after.
use discrepancy::proof::closed::Closed;
use discrepancy::proof::compare::{Portion, Row};
use serde::Serialize;

/// The gap of the answer.
#[derive(Debug, Default, Serialize)]
pub(super) struct GapOutput {
    calibration: Option<Closed>,
    held_out: Option<Closed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out_channels: Option<Closed>,
    other_condition: Option<Closed>,
}

/// The gap of an answer by its rows.
pub(super) fn gap(rows: &[Row]) -> GapOutput {
    let one = |part: Portion| {
        let row = rows.iter().find(|row| row.part == part)?;
        Some(row.closed)
    };
    GapOutput {
        calibration: one(Portion::Fitted),
        held_out: one(Portion::Cycles),
        held_out_channels: one(Portion::Channels),
        other_condition: one(Portion::Condition),
    }
}
