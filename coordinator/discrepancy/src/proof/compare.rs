//! The proof: curves of the model before and after, under every condition that has a record.
use crate::laboratory::{Laboratory, channels};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::proof::closed::{Closed, closed};
use crate::record::measured::{Curves, Record, Split};

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

impl Row {
    /// What it was shown on, in words.
    pub(crate) fn words(&self) -> String {
        self.part.words(self.condition)
    }
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

impl Portion {
    /// In words, of a condition.
    pub(crate) fn words(self, condition: usize) -> String {
        match self {
            Self::Fitted => "the cycles that were fitted".to_owned(),
            Self::Cycles => "the cycles that were held out".to_owned(),
            Self::Channels => "the channels that were held out".to_owned(),
            Self::Condition => format!("condition {} of the case", condition + 1),
        }
    }
}

/// A record of the proof.
#[derive(Clone, Debug)]
pub(crate) struct Shown<'a> {
    /// What was measured.
    pub(crate) record: &'a Record,
    /// Cycles that scatter as its own do, its own among them.
    pub(crate) alike: Vec<Curves>,
    /// What of the records it is.
    pub(crate) part: Portion,
}

/// Everything that an answer is shown on: the calibrated condition's record in parts, then the others.
pub(crate) fn shown<'a>(split: &'a Split, others: &'a [Record]) -> Vec<Shown<'a>> {
    let cycles = || [&split.fitted.cycles[..], &split.cycles.cycles].concat();
    let own = |record: &'a Record, part: Portion| Shown {
        alike: record.cycles.clone(),
        record,
        part,
    };
    let mut all = vec![
        own(&split.fitted, Portion::Fitted),
        Shown {
            alike: cycles(),
            ..own(&split.cycles, Portion::Cycles)
        },
        own(&split.channels, Portion::Channels),
    ];
    all.extend(others.iter().map(|record| own(record, Portion::Condition)));
    all.retain(|one| !one.record.cycles.is_empty() && !one.record.channels.is_empty());
    all
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
                closed: closed(shown.record, &shown.alike, &before, &after),
                before,
                after,
            })
        });
    Ok(rows.collect())
}
