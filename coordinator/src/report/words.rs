//! Verdicts in words, from numbers: what happened, by how much, where it got worse.
//!
//! Says what the data say and no more; every sentence stands by itself.
use super::data::{Calibration, ConditionResult};
use super::number::{figure, percent, quantity};
use protocol::case::{Case, Gene, Integrator, Scale};
use protocol::job::{ChannelScore, ModeFamily, PhysicsFailure, Reached, Verdict};

/// What to know of records that come from no test.
pub(super) const SYNTHETIC: &str = "The gauge records of this case are synthetic: they were \
    computed, not measured on a machine, and say nothing about how well a real one is met.";

/// What ended a simulation, in words.
pub fn failure(kind: PhysicsFailure) -> &'static str {
    match kind {
        PhysicsFailure::OverstretchedRope => "a rope joint was stretched beyond its limit",
        PhysicsFailure::RopeThroughHead => "the rope sank through the surface of a head",
        PhysicsFailure::BeamOvertravel => "the beam left its working range",
        PhysicsFailure::LoadNotLifted => "the load was not lifted",
        PhysicsFailure::TumbledCylinder => "a rope cylinder turned over",
        PhysicsFailure::StepUnderflow => "the step size fell below its limit",
        PhysicsFailure::Budget => "the iteration budget was used up",
    }
}

/// A family of modes.
pub const fn mode_family(family: ModeFamily) -> &'static str {
    match family {
        ModeFamily::Symmetric => "symmetric",
        ModeFamily::Antisymmetric => "antisymmetric",
    }
}

/// A method of integration, as people call it.
pub const fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::TrBdf2 => "TR-BDF2",
        Integrator::Esdirk4 => "ESDIRK4",
        Integrator::Rodas4 => "RODAS4",
        Integrator::GeneralizedAlpha => "generalised-alpha",
        Integrator::Bdf => "BDF, order ≤ 2",
        Integrator::Bdf5 => "BDF, order ≤ 5",
    }
}

/// How a simulation ended, in words, without a full stop.
pub fn verdict(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Complete => "complete revolution".to_owned(),
        Verdict::Failed { kind, reached } => {
            let reached = match reached {
                Reached::LoadFraction(share) => {
                    format!(
                        "at {} of the static load, before any motion",
                        percent(*share)
                    )
                }
                Reached::TimeFraction(share) => {
                    format!("after {} of the simulated time", percent(*share))
                }
            };
            format!("failed: {} {reached}", failure(*kind))
        }
    }
}

/// Score of a gauge, if the run was complete and has it.
fn channel(channels: &[ChannelScore], gauge: u8) -> Option<&ChannelScore> {
    channels.iter().find(|channel| channel.gauge == gauge)
}

/// How a value changed, as "fell from 6.8 to 0.75 (−89 %)".
fn change(from: f64, to: f64, suffix: &str) -> String {
    let verb = if to < from {
        "fell"
    } else if to > from {
        "rose"
    } else {
        return format!("stayed at {}{suffix}", figure(from));
    };
    let share = to / from - 1.0;
    let share = if !share.is_finite() || from <= 0.0 {
        String::new()
    } else if share < 9.0 {
        let sign = if share > 0.0 { "+" } else { "" };
        format!(" ({sign}{})", percent(share))
    } else {
        format!(" ({} times)", figure(to / from))
    };
    format!(
        "{verb} from {} to {}{suffix}{share}",
        figure(from),
        figure(to)
    )
}

/// The objective with the recommended parameters, if their run was complete [MPa^2].
pub(super) fn complete_objective(result: &ConditionResult) -> Option<f64> {
    let evaluation = &result.recommended.evaluation;
    matches!(evaluation.verdict, Verdict::Complete).then_some(evaluation.fitness)
}

/// Headline of a calibration: whether the error fell, and by how much.
pub fn headline(calibration: &Calibration) -> String {
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

/// The same sentence with a capital at its start.
fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// One sentence per gauge of a condition; gauges that got worse are said to be worse.
pub fn gauges(case: &Case, result: &ConditionResult) -> Vec<String> {
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
pub fn absolute_worse(case: &Case, result: &ConditionResult) -> Option<String> {
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
pub fn warnings(calibration: &Calibration) -> Vec<String> {
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

/// A bound of a gene in words, as "its upper bound 1.00e12 N/m".
pub(super) fn bound(gene: &Gene, side: &str) -> String {
    let value = if side == "lower" {
        gene.lower
    } else {
        gene.upper
    };
    format!("its {side} bound {}", quantity(value, gene.unit()))
}

/// Which bound a value touches, within half a per cent of the interval on the gene's scale.
pub(super) fn at_bound(gene: &Gene, value: f64) -> Option<&'static str> {
    let Gene { lower, upper, .. } = *gene;
    let share = match gene.scale() {
        Scale::Logarithmic => (value / lower).ln() / (upper / lower).ln(),
        Scale::Linear => (value - lower) / (upper - lower),
    };
    if share < 0.005 {
        Some("lower")
    } else if share > 0.995 {
        Some("upper")
    } else {
        None
    }
}

/// Name of a condition; its number where the case does not have it.
pub(super) fn condition_name(case: &Case, condition: usize) -> String {
    case.conditions
        .get(condition)
        .map_or_else(|| format!("#{condition}"), |found| found.name.clone())
}

#[cfg(test)]
mod tests {
    use super::{at_bound, bound, change};
    use protocol::{
        case::{Coefficient, Gene, Quantity},
        unit::Unit,
    };

    #[test]
    fn changes_are_said_with_their_direction() {
        assert_eq!(
            change(6.8, 0.75, " MPa²"),
            "fell from 6.80 to 0.750 MPa² (−89.0\u{a0}%)"
        );
        assert_eq!(
            change(1.0, 1.5, ""),
            "rose from 1.00 to 1.50 (+50.0\u{a0}%)"
        );
        assert_eq!(change(1.0, 40.0, ""), "rose from 1.00 to 40.0 (40.0 times)");
        assert_eq!(change(2.0, 2.0, ""), "stayed at 2.00");
    }

    #[test]
    fn bounds_are_noticed_on_the_scale_of_the_gene() {
        let unit = Unit::NewtonPerMetre;
        let stiffness = Gene::coefficient(Coefficient::Kb1, unit, 1e8, [1e4, 1e12]);
        assert_eq!(at_bound(&stiffness, 1e4), Some("lower"));
        assert_eq!(at_bound(&stiffness, 0.99e12), Some("upper"));
        assert_eq!(at_bound(&stiffness, 2e4), None);
        let size = Gene {
            quantity: Quantity::Effect {
                id: "load_offset".to_owned(),
                parameter: "force".to_owned(),
                unit: "N".to_owned(),
            },
            recommended: 0.0,
            lower: -500.0,
            upper: 1500.0,
        };
        assert_eq!(at_bound(&size, -499.0), Some("lower"));
        assert_eq!(at_bound(&size, 0.0), None);
        assert_eq!(at_bound(&size, 1400.0), None);
        assert_eq!(bound(&size, "upper"), "its upper bound 1500\u{a0}N");
    }
}
