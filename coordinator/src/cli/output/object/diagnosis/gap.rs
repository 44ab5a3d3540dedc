//! Gap (unexplained share of the measured variance) before and after the effects were added, and predictive
//! scores.
use discrepancy::proof::closed::Closed;
use discrepancy::proof::compare::{Portion, Row};
use discrepancy::proof::predictive::Prediction;
use protocol::case::Case;
use serde::Serialize;

/// Predictive score: log-likelihood gain (nats) of the found effects on a record excluded from the fit.
#[derive(Debug, Serialize)]
pub(super) struct PredictionOutput {
    /// Name of the condition under which the record was measured.
    record: String,
    nats: f64,
    /// Kind of held-out data: `cycles`, `channel`, `segment`, `condition`, or `left_out` for blocks of the
    /// fitted record.
    held_out: &'static str,
}

/// Converts the predictive scores to their JSON form; scores of fitted data are omitted.
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

/// Gap before and after the effects were added, on the fitted record and on held-out data.
#[derive(Debug, Default, Serialize)]
pub(super) struct GapOutput {
    calibration: Option<Closed>,
    /// Gap on the data that the case holds out (a condition, a channel or a part of its record); on the
    /// held-out cycles if the case holds out nothing.
    held_out: Option<Closed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out_cycles: Option<Closed>,
    other_condition: Option<Closed>,
}

/// Selects the gaps from the comparison rows.
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
