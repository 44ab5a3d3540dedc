//! The proof: curves of the model before and after, under every condition that has a record.
use crate::laboratory::{Laboratory, channels};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::proof::closed::{Closed, closed};
use crate::record::measured::{Curves, Record};

/// The gap before and after on one record.
#[derive(Clone, Debug)]
pub struct Row {
    /// Index of the condition.
    pub condition: usize,
    /// What of the records it is.
    pub part: Portion,
    /// The gap.
    pub closed: Closed,
    /// Curves before, by channel.
    pub before: Curves,
    /// Curves after.
    pub after: Curves,
}

/// Which part of the records a gap is counted on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Portion {
    /// What was fitted.
    Fitted,
    /// Cycles of the calibrated condition that took no part in the fit.
    Cycles,
    /// Channels of the calibrated condition that took no part in it; none of its others.
    Channels,
    /// Another condition.
    Condition,
}

/// A record of the proof.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'a> {
    /// What was measured.
    pub(crate) record: &'a Record,
    /// What of the records it is.
    pub(crate) part: Portion,
}

/// Compares two models on records; nothing for a record on which one of them fails.
pub(crate) async fn compare<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    records: &[Shown<'_>],
    before: &Fit,
    after: &Fit,
) -> Result<Vec<Row>, L::Error> {
    let numerics = &experiments.on.numerics;
    let points = [before, after].map(Fit::point);
    let both = |shown: &Shown<'_>| {
        let condition = shown.record.condition;
        points
            .each_ref()
            .map(|point| point.experiment(condition, numerics))
    };
    let batch = records.iter().flat_map(both).collect();
    let observed = experiments.lab.observe(experiments.stage, batch).await?;
    let rows = records
        .iter()
        .zip(observed.chunks(2))
        .filter_map(|(shown, pair)| {
            let curves = |k: usize| {
                let mut curves = channels(pair.get(k)?.as_ref()?, shown.record)?;
                points[k].read(shown.record, &mut curves);
                Some(curves)
            };
            let (before, after) = (curves(0)?, curves(1)?);
            Some(Row {
                condition: shown.record.condition,
                part: shown.part,
                closed: closed(shown.record, &before, &after),
                before,
                after,
            })
        });
    Ok(rows.collect())
}
