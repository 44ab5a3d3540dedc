//! The gap before and after.
use discrepancy::proof::closed::Closed;
use discrepancy::proof::compare::{Portion, Row};
use discrepancy::proof::predictive::Prediction;
use protocol::case::Case;
use serde::Serialize;

/// How much likelier a record that took no part in the fit is with the answer than without it.
#[derive(Debug, Serialize)]
pub(super) struct PredictionOutput {
    /// Name of its condition.
    record: String,
    nats: f64,
    /// What of the records it is: `cycles`, `channel`, `segment`, `condition`, or `left_out` for blocks of the fitted one.
    held_out: &'static str,
}

/// Predictive scores by record.
pub(super) fn predictions(case: &Case, scores: &[Prediction]) -> Vec<PredictionOutput> {
    let one = |score: &Prediction| {
        Some(PredictionOutput {
            record: case.conditions.get(score.condition)?.name.clone(),
            nats: score.nats,
            held_out: match score.part {
                Portion::Cycles => "cycles",
                Portion::Channels => "channel",
                Portion::Segment => "segment",
                Portion::Condition => "condition",
                Portion::LeftOut => "left_out",
                Portion::Fitted => return None,
            },
        })
    };
    scores.iter().filter_map(one).collect()
}

/// The gap of the answer.
#[derive(Debug, Default, Serialize)]
pub(super) struct GapOutput {
    calibration: Option<Closed>,
    /// What the case holds out: a condition, a channel or a part of its record; else the cycles that were held out.
    held_out: Option<Closed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out_cycles: Option<Closed>,
    other_condition: Option<Closed>,
}

/// The gap of an answer by its rows.
pub(super) fn gap(rows: &[Row]) -> GapOutput {
    let one = |part: Portion| {
        let row = rows.iter().find(|row| row.part == part)?;
        Some(row.closed)
    };
    let cycles = one(Portion::Cycles);
    let marked = rows.iter().find(|row| row.held_out).map(|row| row.closed);
    GapOutput {
        calibration: one(Portion::Fitted),
        held_out: marked.or(cycles),
        held_out_cycles: marked.and(cycles),
        other_condition: one(Portion::Condition),
    }
}
