//! A calibration in words: whether the error fell, where it got worse, what to be warned of.
use super::change::change;
use super::ending::verdict;
use super::gene::{at_bound, bound};
use super::name::{capitalised, condition_name};
use crate::report::data::{Calibration, ConditionResult};
use crate::report::number::{figure, percent, quantity};
use protocol::case::Case;
use protocol::job::{ChannelScore, Verdict};

/// The objective with the recommended parameters, if their run was complete [MPa^2].
pub(in crate::report) fn complete_objective(result: &ConditionResult) -> Option<f64> {
    let evaluation = &result.recommended.evaluation;
    matches!(evaluation.verdict, Verdict::Complete).then_some(evaluation.fitness)
}

/// Headline of a calibration: whether the error fell, and by how much.
pub(in crate::report) fn headline(calibration: &Calibration) -> String {
    let Some(result) = calibration.calibrated() else {
        return "The calibrated condition has no result.".to_owned();
    };
    let name = condition_name(&calibration.case, result.condition);
    let (before, after) = (&result.recommended.evaluation, &result.optimised.evaluation);
    let what = objective(&calibration.case);
    match (before.verdict, after.verdict) {
        (_, failed @ Verdict::Failed { .. }) => format!(
            "No usable parameters were found: under condition {name} the best individual {}.",
            verdict(&failed)
        ),
        (failed @ Verdict::Failed { .. }, Verdict::Complete) => format!(
            "With the optimised parameters, {what} is {} MPa² under condition {name}. With the \
             recommended ones the simulation {}, so there is no error to compare with.",
            figure(after.fitness),
            verdict(&failed)
        ),
        (Verdict::Complete, Verdict::Complete) if after.fitness < before.fitness => format!(
            "{} {} under condition {name}.",
            capitalised(&what),
            change(before.fitness, after.fitness, " MPa²")
        ),
        (Verdict::Complete, Verdict::Complete) => format!(
            "The search found nothing better than the recommended parameters: {what} {} under \
             condition {name}.",
            change(before.fitness, after.fitness, " MPa²")
        ),
    }
}

/// What is minimised, in words.
fn objective(case: &Case) -> String {
    let gauges: Vec<_> = case
        .objective
        .gauges
        .iter()
        .map(|(gauge, _)| gauge.to_string())
        .collect();
    let weighted = case
        .objective
        .gauges
        .iter()
        .any(|&(_, weight)| (weight - 1.0).abs() > 1e-12);
    let sum = if weighted { "weighted sum" } else { "sum" };
    match gauges.as_slice() {
        [one] => format!("the mean squared error at point {one}"),
        _ => format!(
            "the {sum} of the mean squared errors at points {}",
            gauges.join(" and ")
        ),
    }
}

/// One sentence per gauge of a condition; gauges that got worse are said to be worse.
pub(in crate::report) fn gauges(case: &Case, result: &ConditionResult) -> Vec<String> {
    let before = &result.recommended.evaluation.channels;
    let after = &result.optimised.evaluation.channels;
    let calibrated = result.condition == case.objective.condition;
    after
        .iter()
        .map(|new| {
            let weighted = case.objective.gauges.iter().any(|&(g, _)| g == new.gauge);
            let role = if calibrated && !weighted {
                " (took no part in the fit)"
            } else {
                ""
            };
            let gauge = new.gauge;
            match channel(before, gauge) {
                Some(old) => {
                    let worse = if new.mse_mpa2 > old.mse_mpa2 {
                        "worse: "
                    } else {
                        ""
                    };
                    format!(
                        "Point {gauge}{role}: {worse}mean squared error {}; relative error {} → {}.",
                        change(old.mse_mpa2, new.mse_mpa2, " MPa²"),
                        percent(old.relative_error),
                        percent(new.relative_error),
                    )
                }
                None => format!(
                    "Point {gauge}{role}: mean squared error {} MPa², relative error {}; no \
                     complete run with the recommended parameters to compare with.",
                    figure(new.mse_mpa2),
                    percent(new.relative_error),
                ),
            }
        })
        .collect()
}

/// One sentence about the points whose absolute error rose although the error without offset
/// fell: a free offset would hide it. None where there is no such point.
pub(in crate::report) fn absolute_worse(case: &Case, result: &ConditionResult) -> Option<String> {
    let before = &result.recommended.evaluation.channels;
    let changes: Vec<String> = result
        .optimised
        .evaluation
        .channels
        .iter()
        .filter_map(|new| {
            let old = channel(before, new.gauge)?;
            let hidden = new.mse_mpa2 < old.mse_mpa2
                && new.mse_fixed_offset_mpa2 > old.mse_fixed_offset_mpa2;
            let (from, to) = (old.mse_fixed_offset_mpa2, new.mse_fixed_offset_mpa2);
            hidden.then(|| format!("at point {} it {}", new.gauge, change(from, to, " MPa²")))
        })
        .collect();
    (!changes.is_empty()).then(|| {
        format!(
            "Under condition {} the absolute mean squared error (offset not removed) got worse \
             although the one without offset fell: {}.",
            condition_name(case, result.condition),
            changes.join(", ")
        )
    })
}

/// Warnings that follow from the data of a calibration.
pub(in crate::report) fn warnings(calibration: &Calibration) -> Vec<String> {
    let case = &calibration.case;
    let mut warnings = Vec::new();
    for result in &calibration.conditions {
        let name = condition_name(case, result.condition);
        for (who, run) in [
            ("recommended", &result.recommended),
            ("optimised", &result.optimised),
        ] {
            if let failed @ Verdict::Failed { .. } = run.simulation.verdict {
                warnings.push(format!(
                    "With the {who} parameters condition {name} {}; its curves end there.",
                    verdict(&failed)
                ));
            }
        }
        let before = &result.recommended.evaluation.channels;
        for new in &result.optimised.evaluation.channels {
            if channel(before, new.gauge).is_some_and(|old| new.mse_mpa2 > old.mse_mpa2) {
                warnings.push(format!(
                    "Point {} is worse with the optimised parameters under condition {name}.",
                    new.gauge
                ));
            }
        }
    }
    for (gene, &value) in case.genes.iter().zip(&calibration.optimised.genes) {
        if let Some(side) = at_bound(gene, value) {
            warnings.push(format!(
                "{} ended at {} ({}): the optimum may lie outside.",
                gene.label(),
                bound(gene, side),
                quantity(value, gene.unit())
            ));
        }
    }
    warnings
}

/// Score of a gauge, if the run was complete and has it.
fn channel(channels: &[ChannelScore], gauge: u8) -> Option<&ChannelScore> {
    channels.iter().find(|channel| channel.gauge == gauge)
}
