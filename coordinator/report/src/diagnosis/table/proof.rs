//! Tables of the gap before and after: above the noise, and in the error measures of the reference paper.
use crate::diagnosis::shown::{Shown, shown};
use crate::diagnosis::subject::Subject;
use crate::diagnosis::words;
use crate::document::{Row, Table};
use crate::number::{NONE, figure, percent, squared};
use crate::words::{condition_name, headed};
use discrepancy::proof::compare;
use std::collections::BTreeSet;

/// Builds the table of the gap before and after, for the answer, the best rejected rival effect and the
/// generic force.
pub(in crate::diagnosis) fn gaps(subject: &Subject<'_>) -> Option<Table> {
    let diagnosis = subject.diagnosis();
    let added = !subject.added().is_empty();
    let mut rows: Vec<Row> = Vec::new();
    if !diagnosis.rows.is_empty() {
        let whose = if added {
            "the answer"
        } else {
            "the recalibrated model, to which nothing was added"
        };
        rows.push(Row::group(whose));
        rows.extend(diagnosis.rows.iter().map(|row| gap(subject, row, added)));
    }
    if let Some((id, rival)) = &diagnosis.rival {
        rows.push(Row::group(format!("the best rejected rival, {id}")));
        rows.extend(rival.iter().map(|row| gap(subject, row, true)));
    }
    if let Some(force) = &diagnosis.force {
        rows.push(Row::group(format!(
            "the force without a cause, {}",
            force.id
        )));
        rows.extend(force.rows.iter().map(|row| gap(subject, row, true)));
    }
    Table::new(
            "The gap before and after",
            ["", "before", "after", "closed", "95\u{a0}% interval"],
            rows,
        ).noted([
            "Gap: mean over the channels of the squared residual above the noise of the averaged record, \
             over the variance of the measured curve; means removed. Interval: the cycles drawn again \
             1000 times, before and after on the same draw, less the scatter of the draws themselves.",
            "A gap that closes does not prove a name: a wrong effect often closes most of it, which is \
             why the rival stands beside it.",
        ]).noted(diagnosis.whiteness.map(|p| whiteness(subject, p))).unless_empty()
}

/// States the p-values of the whiteness test of the residual before and after.
fn whiteness(subject: &Subject<'_>, [before, after]: [f64; 2]) -> String {
    let channels = subject.records.iter().flat_map(|record| &record.channels);
    let along = channels
        .map(|own| own.channel.abscissa.name.as_str())
        .next();
    let along = along.unwrap_or("period");
    format!(
        "Is what is left white, spread over the orders of the {along} as noise is? p: {} before, {} after \
         (calibration cycles, against their scatter).",
        words::p_value(before),
        words::p_value(after)
    )
}

/// Builds one row of the gap table; the columns "after", "closed" and the interval show a dash if the model
/// did not change.
fn gap(subject: &Subject<'_>, of: &compare::Row, changed: bool) -> Row {
    let small = |share: f64| {
        if share.is_finite() {
            format!("{}\u{a0}%", figure(100.0 * share))
        } else {
            NONE.to_owned()
        }
    };
    Row::new(
        format!(
            "{}, {}",
            condition_name(subject.case, of.condition),
            words::role(of)
        ),
        [
            small(of.closed.before),
            if changed {
                small(of.closed.after)
            } else {
                NONE.to_owned()
            },
            if changed {
                percent(of.closed.closed)
            } else {
                NONE.to_owned()
            },
            of.closed.interval.filter(|_| changed).map_or_else(
                || NONE.to_owned(),
                |[low, high]| format!("{} to {}", percent(low), percent(high)),
            ),
        ],
    )
}

/// Builds the table of the reference paper's two error measures, by scored channel.
pub(in crate::diagnosis) fn paper(subject: &Subject<'_>) -> Option<Table> {
    let all = shown(subject);
    let scored = all.iter().flat_map(|shown| {
        let scored = shown.record.scored().into_iter();
        scored.map(|c| shown.record.channels[c].channel.unit.as_str())
    });
    let units: BTreeSet<&str> = scored.collect();
    // a unit that all have stands above them, others stand in their rows
    let common = units.first().copied().filter(|_| units.len() == 1);
    let mut rows = Vec::new();
    for shown in &all {
        rows.push(Row::group(format!("condition {}", shown.condition)));
        let scored = shown.record.scored().into_iter();
        rows.extend(scored.filter_map(|c| errors(shown, c, common.is_none())));
    }
    Table::new(
            "The same in the reference paper's measures",
            [
                "",
                &headed("MSE before", &squared(common)),
                "after",
                "rival",
                "relative error before",
                "after",
                "rival",
            ],
            rows,
).noted([
            "MSE: mean squared difference of the measured mean and the simulated curve, with the offset \
             as the case's objective treats it; noise included. Relative error: mean absolute difference \
             over the mean absolute deviation of the measured curve from its own mean.",]).unless_empty()
}

fn errors(shown: &Shown<'_>, c: usize, with_unit: bool) -> Option<Row> {
    let of = shown.channel(c)?;
    let n = of.measured.len() as f64;
    let mean = of.measured.iter().sum::<f64>() / n;
    let deviation = of.measured.iter().map(|m| (m - mean).abs()).sum::<f64>();
    let square = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        figure(residual.iter().map(|r| r * r).sum::<f64>() / n)
    };
    let relative = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        percent(residual.iter().map(|r| r.abs()).sum::<f64>() / deviation)
    };
    let all = [Some(of.before), of.after, of.rival.map(|(_, rival)| rival)];
    let cells = all
        .map(|s| s.map_or_else(|| NONE.to_owned(), square))
        .into_iter()
        .chain(all.map(|s| s.map_or_else(|| NONE.to_owned(), relative)));
    let unit = if with_unit {
        squared(Some(of.unit))
    } else {
        String::new()
    };
    Some(Row::new(
        headed(of.channel, &unit),
        cells.collect::<Vec<_>>(),
    ))
}
