//! Gap (unexplained share of the measured variance) before and after the effects were added, and predictive
//! scores.
use discrepancy::diagnose::Left;
use discrepancy::validation::compare::{DataRole, GapRow};
use discrepancy::validation::gap_closure::Closed;
use discrepancy::validation::predictive::Prediction;
use protocol::case::Case;
use serde::Serialize;

/// Predictive score: log-likelihood gain (nats) of the found effects on a record excluded from the fit.
#[derive(Debug, Serialize)]
pub(super) struct PredictionOutput {
    /// Name of the condition under which the record was measured.
    record: String,
    nats: f64,
    /// Kind of held-out data: `cycles`, `channel`, `segment` or `condition`.
    held_out: &'static str,
}

/// Converts the predictive scores to their JSON form; scores of fitted data are omitted.
pub(super) fn predictions(case: &Case, scores: &[Prediction]) -> Vec<PredictionOutput> {
    let one = |score: &Prediction| {
        Some(PredictionOutput {
            record: case.conditions.get(score.condition)?.name.clone(),
            nats: score.nats,
            held_out: held_out(score.part)?,
        })
    };
    scores.iter().filter_map(one).collect()
}

/// Returns the keyword of a kind of held-out data; `None` for fitted data.
const fn held_out(part: DataRole) -> Option<&'static str> {
    match part {
        DataRole::Cycles => Some("cycles"),
        DataRole::Channels => Some("channel"),
        DataRole::Segment => Some("segment"),
        DataRole::Condition => Some("condition"),
        DataRole::Fitted => None,
    }
}

/// Record on which the model of the answer leaves more than noise.
#[derive(Debug, Serialize)]
pub(super) struct LeftOutput {
    /// Name of the condition under which the record was measured.
    record: String,
    /// Kind of held-out data, as in a predictive score; null for the fitted record.
    held_out: Option<&'static str>,
    /// Share of the gap without effects that is left.
    share: f64,
    /// Title of the channel in which most is left.
    channel: String,
    /// Shortest range of the abscissa with half of that channel's squared residual.
    between: [f64; 2],
    /// Unit of the abscissa.
    unit: String,
}

/// Converts the records on which an answer leaves more than noise to their JSON form.
pub(super) fn left(case: &Case, all: &[Left]) -> Vec<LeftOutput> {
    let one = |left: &Left| {
        Some(LeftOutput {
            record: case.conditions.get(left.condition)?.name.clone(),
            held_out: held_out(left.part),
            share: left.share,
            channel: left.channel.clone(),
            between: left.between,
            unit: left.unit.clone(),
        })
    };
    all.iter().filter_map(one).collect()
}

/// Gap (unexplained share of the measured variance) before and after the effects were added, on the fitted
/// record and on held-out data.
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

/// Selects the gap before and after the effects for each kind of data from the rows of the gap comparison.
pub(super) fn gap(rows: &[GapRow]) -> GapOutput {
    let one = |part: DataRole| {
        let row = rows.iter().find(|row| row.part == part)?;
        Some(row.closed)
    };
    let cycles = one(DataRole::Cycles);
    let marked = rows.iter().find(|row| row.held_out).map(|row| row.closed);
    GapOutput {
        calibration: one(DataRole::Fitted),
        held_out: marked.or(cycles),
        held_out_cycles: marked.and(cycles),
        other_condition: one(DataRole::Condition),
    }
}
