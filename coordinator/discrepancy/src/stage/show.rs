//! The proof: curves of the model before and after, under every condition that has a record.
use crate::bench::Fit;
use crate::laboratory::{Laboratory, Stage, channels};
use crate::record::{Curves, Record};
use crate::show::{Closed, closed};
use protocol::job::Refinement;

/// The gap before and after on one record.
#[derive(Clone, Debug)]
pub struct Row {
    /// Index of the condition.
    pub condition: usize,
    /// Whether its cycles took part in the fit.
    pub fitted: bool,
    /// The gap.
    pub closed: Closed,
    /// Curves before, by channel.
    pub before: Curves,
    /// Curves after.
    pub after: Curves,
}

/// Compares two models on records; nothing for a record on which one of them fails.
///
/// # Errors
/// Of the laboratory.
pub async fn compare<L: Laboratory>(
    lab: &mut L,
    records: &[(&Record, bool)],
    (before, after): (&Fit, &Fit),
    refinement: Refinement,
) -> Result<Vec<Row>, L::Error> {
    let batch = records
        .iter()
        .flat_map(|(record, _)| {
            [before, after].map(|fit| fit.model.experiment(fit.x(), record.condition, refinement))
        })
        .collect();
    let observed = lab.observe(Stage::Show, batch).await?;
    let rows = records
        .iter()
        .zip(observed.chunks(2))
        .filter_map(|((record, fitted), pair)| {
            let curves = |k: usize| channels(pair.get(k)?.as_ref()?, &record.channels);
            let (before, after) = (curves(0)?, curves(1)?);
            (!record.cycles.is_empty()).then(|| Row {
                condition: record.condition,
                fitted: *fitted,
                closed: closed(record, &before, &after),
                before,
                after,
            })
        });
    Ok(rows.collect())
}
