//! Recommended against optimised parameters (paper, Tables 3 and 4).
use super::{Label, Row, Table};
use crate::report::data::{Calibration, ConditionResult, Run};
use crate::report::number::{NONE, figure, fixed, percent, ratio, unit};
use crate::report::words::{self, condition_name};
use protocol::case::{Case, Coefficient, Quantity};
use protocol::job::{ChannelScore, Verdict};

/// Definition that stands under every table with relative errors.
const RELATIVE_ERROR: &str = "Relative error: mean absolute error over the mean absolute deviation \
                              of the measured curve from its own mean.";
const HALF_RANGE: &str = "RMSE / half-range: root of the mean squared error over half the measured \
                          range.";
const OFFSET: &str = "Offset: measured minus simulated mean; a strain bridge has no absolute zero.";

/// Gauges of a result: those of the objective first, then the others of the record.
fn gauges(case: &Case, result: &ConditionResult) -> Vec<u8> {
    let mut gauges: Vec<u8> = case.objective.gauges.iter().map(|&(g, _)| g).collect();
    for run in [&result.recommended, &result.optimised] {
        for channel in &run.evaluation.channels {
            if !gauges.contains(&channel.gauge) {
                gauges.push(channel.gauge);
            }
        }
    }
    gauges
}

/// A row of one quantity of one gauge for both parameter sets.
fn channel_row(
    label: String,
    unit: &str,
    result: &ConditionResult,
    gauge: u8,
    value: impl Fn(&ChannelScore) -> f64,
    write: impl Fn(f64) -> String,
) -> Row {
    let of = |run: &Run| {
        let mut channels = run.evaluation.channels.iter();
        channels.find(|c| c.gauge == gauge).map(&value)
    };
    let (before, after) = (of(&result.recommended), of(&result.optimised));
    let share = match (before, after) {
        (Some(before), Some(after)) if before > 0.0 && after >= 0.0 => ratio(after, before),
        _ => NONE.to_owned(),
    };
    let write = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), &write);
    Row::new(label, [unit.to_owned(), write(before), write(after), share])
}

/// Objective and agreement at every gauge of a condition.
fn agreement(case: &Case, result: &ConditionResult) -> Vec<Row> {
    let gauges = gauges(case, result);
    let calibrated = result.condition == case.objective.condition;
    let point = |gauge: u8| {
        let weighted = case.objective.gauges.iter().any(|&(g, _)| g == gauge);
        if weighted || !calibrated {
            format!("point {gauge}")
        } else {
            format!("point {gauge} (not fitted)")
        }
    };
    let mut rows = Vec::new();
    let objective = |run: &Run| match run.evaluation.verdict {
        Verdict::Complete => Some(run.evaluation.fitness),
        Verdict::Failed { .. } => None,
    };
    let (before, after) = (objective(&result.recommended), objective(&result.optimised));
    let write = |value: Option<f64>| value.map_or_else(|| "failed".to_owned(), figure);
    rows.push(Row::Group("Objective".to_owned()));
    rows.push(Row::new(
        "weighted sum of mean squared errors",
        [
            "MPa²".to_owned(),
            write(before),
            write(after),
            match (before, after) {
                (Some(before), Some(after)) => ratio(after, before),
                _ => NONE.to_owned(),
            },
        ],
    ));
    rows.push(Row::Group("Mean squared error".to_owned()));
    for &g in &gauges {
        rows.push(channel_row(
            point(g),
            "MPa²",
            result,
            g,
            |c| c.mse_mpa2,
            figure,
        ));
    }
    rows.push(Row::Group("MSE, absolute (offset not removed)".to_owned()));
    for &g in &gauges {
        let value = |c: &ChannelScore| c.mse_fixed_offset_mpa2;
        rows.push(channel_row(point(g), "MPa²", result, g, value, figure));
    }
    rows.push(Row::Group("Relative error".to_owned()));
    for &g in &gauges {
        rows.push(channel_row(
            point(g),
            "",
            result,
            g,
            |c| c.relative_error,
            percent,
        ));
    }
    rows.push(Row::Group("RMSE / half-range".to_owned()));
    for &g in &gauges {
        let value = |c: &ChannelScore| c.rmse_over_half_range;
        rows.push(channel_row(point(g), "", result, g, value, percent));
    }
    // a ratio of signed errors or of offsets would say nothing
    rows.push(Row::Group("Error of the peak-to-peak stress".to_owned()));
    for &g in &gauges {
        let value = |c: &ChannelScore| c.peak_to_peak_error;
        let mut row = channel_row(point(g), "", result, g, value, percent);
        blank_ratio(&mut row);
        rows.push(row);
    }
    rows.push(Row::Group("Offset".to_owned()));
    for &g in &gauges {
        let write = |value| fixed(value, 2);
        let mut row = channel_row(point(g), "MPa", result, g, |c| c.offset_mpa, write);
        blank_ratio(&mut row);
        rows.push(row);
    }
    rows
}

fn blank_ratio(row: &mut Row) {
    if let Row::Values(_, cells) = row
        && let Some(last) = cells.last_mut()
    {
        last.clear();
    }
}

fn head() -> Vec<String> {
    [
        "",
        "unit",
        "recommended",
        "optimised",
        "optimised / recommended",
    ]
    .map(str::to_owned)
    .to_vec()
}

/// Rows of both gene vectors.
fn gene_rows(calibration: &Calibration) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut group = "";
    let genes = calibration.case.genes.iter().enumerate();
    for (index, gene) in genes {
        let name = match gene.quantity {
            Quantity::Coefficient {
                name: Coefficient::Kc | Coefficient::Cc,
                ..
            } => "Contact",
            Quantity::Coefficient { .. } => "Rope joints",
            Quantity::Effect { .. } => "Effects",
        };
        if name != group {
            rows.push(Row::Group(name.to_owned()));
            group = name;
        }
        let value = |genes: &[f64]| genes.get(index).copied().unwrap_or(f64::NAN);
        let before = value(&calibration.recommended.genes);
        let after = value(&calibration.optimised.genes);
        let mut optimised = figure(after);
        if words::at_bound(gene, after).is_some() {
            optimised.push_str(" *");
        }
        rows.push(Row::Values(
            Label::of(gene),
            vec![
                unit(gene.unit()),
                figure(before),
                optimised,
                ratio(after, before),
            ],
        ));
    }
    rows
}

/// The paper's Table 3: genes, and agreement under the calibrated condition.
pub fn table_3(calibration: &Calibration) -> Table {
    let case = &calibration.case;
    let mut rows = gene_rows(calibration);
    let mut notes = vec![
        RELATIVE_ERROR.to_owned(),
        HALF_RANGE.to_owned(),
        OFFSET.to_owned(),
    ];
    let genes = case.genes.iter().zip(&calibration.optimised.genes);
    let bounds: Vec<String> = genes
        .filter_map(|(gene, &value)| {
            let side = words::at_bound(gene, value)?;
            let bound = words::bound(gene, side);
            Some(format!("{} at {bound}", gene.label()))
        })
        .collect();
    if !bounds.is_empty() {
        let bounds = bounds.join(", ");
        notes.insert(0, format!("* at a bound of the search: {bounds}."));
    }
    if let Some(result) = calibration.calibrated() {
        rows.extend(agreement(case, result));
        notes.extend(words::absolute_worse(case, result));
        notes.extend(failures(result));
    }
    Table {
        title: format!(
            "Recommended and optimised parameters, calibrated condition {}",
            condition_name(case, case.objective.condition)
        ),
        head: head(),
        rows,
        notes,
    }
}

/// The paper's Table 4: agreement under one condition, with the same parameters.
pub fn table_4(case: &Case, result: &ConditionResult) -> Table {
    let mut notes = [RELATIVE_ERROR, HALF_RANGE, OFFSET]
        .map(str::to_owned)
        .to_vec();
    notes.extend(words::absolute_worse(case, result));
    notes.extend(failures(result));
    let role = if result.condition == case.objective.condition {
        "the calibrated condition"
    } else {
        "which took no part in the fit"
    };
    Table {
        title: format!(
            "The same parameters under condition {}, {role}",
            condition_name(case, result.condition)
        ),
        head: head(),
        rows: agreement(case, result),
        notes,
    }
}

/// Says which of the two runs failed, and how.
fn failures(result: &ConditionResult) -> Vec<String> {
    [
        ("Recommended", &result.recommended),
        ("Optimised", &result.optimised),
    ]
    .into_iter()
    .filter_map(|(who, run)| match run.evaluation.verdict {
        Verdict::Complete => None,
        failed @ Verdict::Failed { .. } => {
            Some(format!("{who} parameters {}.", words::verdict(&failed)))
        }
    })
    .collect()
}
