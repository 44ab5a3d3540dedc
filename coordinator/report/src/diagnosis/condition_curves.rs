//! Curves of a diagnosis by condition: measured, and simulated without the added effects, with them, and with
//! the best rejected rival.
use super::subject::DiagnosisInput;
use crate::{
    chart::{ChartAxis, GapComparison},
    words::condition_name,
};
use record::{Curves, Record};

/// Measured and simulated curves of one condition, on the grid of its record.
#[derive(Clone, Debug)]
pub(super) struct ConditionCurves<'a> {
    /// Name of the condition.
    pub condition: String,
    /// Measured record.
    pub record: &'a Record,
    /// Horizontal axes, one per channel.
    pub axes: Vec<ChartAxis>,
    /// Mean of the measured values over all cycles, by channel.
    pub mean: Curves,
    /// Standard deviation of one cycle, by channel; empty lists where there is one cycle only.
    pub spread: Curves,
    /// Curves simulated with the recalibrated baseline model, by channel.
    pub before: &'a Curves,
    /// Curves simulated with the model including the added effects, if any were added.
    pub after: Option<&'a Curves>,
    /// Identifier of the best rejected rival effect, and the curves of the model with that effect.
    pub rival: Option<(&'a str, &'a Curves)>,
}

impl ConditionCurves<'_> {
    /// Returns the measured and simulated curves of the channel with index `c`; `None` if the index or a
    /// curve is missing.
    pub(super) fn channel(&self, c: usize) -> Option<GapComparison<'_>> {
        let channel = &self.record.channels.get(c)?.channel;
        Some(GapComparison {
            condition: &self.condition,
            channel: &channel.title,
            unit: &channel.unit,
            at: &channel.abscissa.points,
            axis: self.axes.get(c)?,
            measured: self.mean.get(c)?,
            spread: self.spread.get(c).map_or(&[], Vec::as_slice),
            cycles: self.record.cycles.len(),
            before: self.before.get(c)?,
            after: self.after.and_then(|after| after.get(c)).map(Vec::as_slice),
            rival: self
                .rival
                .and_then(|(id, rival)| Some((id, rival.get(c)?.as_slice()))),
            free_offset: !channel.is_absolute(),
        })
    }

    /// Returns the indices of the record's channels, scored channels first.
    pub(super) fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.record.channels.len()).collect();
        order.sort_by_key(|&c| !self.record.channels[c].scored);
        order
    }
}

/// Returns the curves of every compared condition, in the order of the comparison; only the calibrated
/// condition if no comparison was made.
pub(super) fn condition_curves<'a>(subject: &DiagnosisInput<'a>) -> Vec<ConditionCurves<'a>> {
    let diagnosis = subject.diagnosis();
    let found = diagnosis.rounds.iter().any(|round| round.added.is_some());
    let mut all: Vec<ConditionCurves<'a>> = Vec::new();
    let mut seen = Vec::new();
    for row in &diagnosis.rows {
        if seen.contains(&row.condition) {
            continue;
        }
        seen.push(row.condition);
        let rival = diagnosis.rival.as_ref().and_then(|(id, rows)| {
            let row = rows.iter().find(|other| other.condition == row.condition)?;
            Some((id.as_str(), &row.after))
        });
        all.extend(
            before(subject, row.condition, &row.before).map(|shown| ConditionCurves {
                after: found.then_some(&row.after),
                rival,
                ..shown
            }),
        );
    }
    if let (true, Some(fit)) = (all.is_empty(), &diagnosis.before) {
        let calibrated = subject.case.objective.condition;
        all.extend(before(subject, calibrated, &fit.curves));
    }
    all
}

/// Builds the measured and simulated curves of a condition, of the simulated ones only those of the
/// recalibrated model.
fn before<'a>(
    subject: &DiagnosisInput<'a>,
    condition: usize,
    curves: &'a Curves,
) -> Option<ConditionCurves<'a>> {
    let record = subject.record(condition)?;
    let mean = record.mean();
    let channels = record.channels.iter();
    let axes = channels.map(|own| ChartAxis::of(subject.case, &own.channel.abscissa));
    Some(ConditionCurves {
        condition: condition_name(subject.case, condition),
        axes: axes.collect(),
        spread: spread(record, &mean),
        mean,
        record,
        before: curves,
        after: None,
        rival: None,
    })
}

/// Computes the standard deviation of the cycles about their mean, by channel; empty for a single cycle.
fn spread(record: &Record, mean: &Curves) -> Curves {
    let cycles = record.cycles.len();
    if cycles < 2 {
        return Vec::new();
    }
    let channel = |(c, mean): (usize, &Vec<f64>)| -> Vec<f64> {
        let at = |(i, m): (usize, &f64)| {
            let squares = record
                .cycles
                .iter()
                .map(|cycle| (cycle[c][i] - m) * (cycle[c][i] - m));
            (squares.sum::<f64>() / (cycles - 1) as f64).sqrt()
        };
        mean.iter().enumerate().map(at).collect()
    };
    mean.iter().enumerate().map(channel).collect()
}
