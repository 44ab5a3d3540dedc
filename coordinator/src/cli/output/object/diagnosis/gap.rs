//! The gap before and after.
use discrepancy::proof::closed::Closed;
use discrepancy::proof::compare::{Portion, Row};
use discrepancy::proof::weighed::Weighed;
use serde::Serialize;

/// The gap of the answer.
#[derive(Debug, Default, Serialize)]
pub(super) struct GapOutput {
    calibration: Option<ClosedOutput>,
    held_out: Option<ClosedOutput>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out_channels: Option<ClosedOutput>,
    other_condition: Option<ClosedOutput>,
}

/// The gap on a part of the records, with what it is in the metric of the tests.
#[derive(Clone, Copy, Debug, Serialize)]
struct ClosedOutput {
    #[serde(flatten)]
    closed: Closed,
    weighed: Weighed,
}

/// The gap of an answer by its rows.
pub(super) fn gap(rows: &[Row]) -> GapOutput {
    let one = |part: Portion| {
        let row = rows.iter().find(|row| row.part == part)?;
        Some(ClosedOutput {
            closed: row.closed,
            weighed: row.weighed,
        })
    };
    GapOutput {
        calibration: one(Portion::Fitted),
        held_out: one(Portion::Cycles),
        held_out_channels: one(Portion::Channels),
        other_condition: one(Portion::Condition),
    }
}
