//! Tables of the gap between model and measurement before and after adding effects: above the noise, and in
//! the error measures of the reference paper.
use crate::diagnosis::condition_curves::{ConditionCurves, condition_curves};
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::words;
use crate::document::{Row, Table};
use crate::number::{MISSING, percent, significant, squared};
use crate::words::{condition_name, with_unit};
use discrepancy::validation::compare;
use std::collections::BTreeSet;

/// Builds the table of the gap between model and measurement before and after a change of the model: by the
/// added effects, the best rejected rival effect and the generic force.
pub(in crate::diagnosis) fn gaps(subject: &DiagnosisInput<'_>) -> Option<Table> {
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
        ).with_notes([
            "Gap: mean over the channels of the squared residual above the noise of the averaged record, \
             over the variance of the measured curve; means removed. Interval: the cycles drawn again \
             1000 times, before and after on the same draw, less the scatter of the draws themselves.",
            "A gap that closes does not prove a name: a wrong effect often closes most of it, which is \
             why the rival stands beside it.",
        ]).with_notes(words::predictive_scores(subject)).with_notes(diagnosis.whiteness.map(|p| whiteness(subject, p))).non_empty()
}

/// States the p-values of a whiteness test of the residual, without and with the added effects.
fn whiteness(subject: &DiagnosisInput<'_>, [before, after]: [f64; 2]) -> String {
    let channels = subject
        .diagnosed
        .records
        .iter()
        .flat_map(|record| &record.channels);
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
fn gap(subject: &DiagnosisInput<'_>, of: &compare::GapRow, changed: bool) -> Row {
    let small = |share: f64| {
        if share.is_finite() {
            format!("{}\u{a0}%", significant(100.0 * share))
        } else {
            MISSING.to_owned()
        }
    };
    Row::new(
        format!(
            "{}, {}",
            condition_name(subject.case, of.condition),
            words::data_role(of)
        ),
        [
            small(of.closed.before),
            if changed {
                small(of.closed.after)
            } else {
                MISSING.to_owned()
            },
            if changed {
                percent(of.closed.closed)
            } else {
                MISSING.to_owned()
            },
            of.closed.interval.filter(|_| changed).map_or_else(
                || MISSING.to_owned(),
                |[low, high]| format!("{} to {}", percent(low), percent(high)),
            ),
        ],
    )
}

/// Builds the table of the reference paper's two error measures, by scored channel.
pub(in crate::diagnosis) fn paper(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let all = condition_curves(subject);
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
                &with_unit("MSE before", &squared(common)),
                "after",
                "rival",
                "relative error before",
                "after",
                "rival",
            ],
            rows,
).with_notes([
            "MSE: mean squared difference of the measured mean and the simulated curve, with the offset \
             as the case's objective treats it; noise included. Relative error: mean absolute difference \
             over the mean absolute deviation of the measured curve from its own mean.",]).non_empty()
}

fn errors(shown: &ConditionCurves<'_>, c: usize, has_unit: bool) -> Option<Row> {
    let of = shown.channel(c)?;
    let n = of.measured.len() as f64;
    let mean = of.measured.iter().sum::<f64>() / n;
    let deviation = of.measured.iter().map(|m| (m - mean).abs()).sum::<f64>();
    let square = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        significant(residual.iter().map(|r| r * r).sum::<f64>() / n)
    };
    let relative = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        percent(residual.iter().map(|r| r.abs()).sum::<f64>() / deviation)
    };
    let all = [Some(of.before), of.after, of.rival.map(|(_, rival)| rival)];
    let cells = all
        .map(|s| s.map_or_else(|| MISSING.to_owned(), square))
        .into_iter()
        .chain(all.map(|s| s.map_or_else(|| MISSING.to_owned(), relative)));
    let unit = if has_unit {
        squared(Some(of.unit))
    } else {
        String::new()
    };
    Some(Row::new(
        with_unit(of.channel, &unit),
        cells.collect::<Vec<_>>(),
    ))
}
