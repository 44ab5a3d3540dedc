//! Sentences about a calibration: change of the objective, channels that got worse, warnings.
use super::change::change;
use super::gene::{at_bound, bound};
use super::name::{calibrated, capitalised, channel_title, condition_name, is_fitted, join_words};
use super::outcome::verdict;
use crate::data::{Calibration, ConditionResult, is_determined};
use crate::machine_check::MachineCheck;
use crate::number::{fixed, percent, quantity, ratio, significant, squared};
use discrepancy::identify::{Determination, UnknownEstimate};
use discrepancy::thresholds::NOISE_RATIO_LIMIT;
use protocol::case::{Case, Channel, Scale, Term, Unknown};
use protocol::job::{ChannelScore, Verdict};

/// Returns the objective with the recommended parameters, if their simulations were complete.
pub(crate) fn complete_objective(calibration: &Calibration) -> Option<f64> {
    let (verdict, fitness) = calibration.objective(|result| &result.recommended)?;
    matches!(verdict, Verdict::Complete).then_some(fitness)
}

/// Returns the headline of a calibration: whether the objective fell, and by how much.
pub(crate) fn headline(calibration: &Calibration) -> String {
    let before = calibration.objective(|result| &result.recommended);
    let after = calibration.objective(|result| &result.optimised);
    let (Some((ended, before)), Some((finished, after))) = (before, after) else {
        return "The calibrated condition has no result.".to_owned();
    };
    let name = calibrated(&calibration.case);
    let what = objective(&calibration.case);
    let unit = square_after(calibration.case.objective_unit());
    match (ended, finished) {
        (_, failed @ Verdict::Failed { .. }) => format!(
            "No usable parameters were found: under {name} the best individual {}.",
            verdict(&failed)
        ),
        (failed @ Verdict::Failed { .. }, Verdict::Complete) => format!(
            "With the optimised parameters, {what} is {}{unit} under {name}. With the \
             recommended ones the simulation {}, so there is no error to compare with.",
            significant(after),
            verdict(&failed)
        ),
        (Verdict::Complete, Verdict::Complete) if after < before => format!(
            "{} {} under {name}.",
            capitalised(&what),
            change(before, after, &unit)
        ),
        (Verdict::Complete, Verdict::Complete) => format!(
            "The search found nothing better than the recommended parameters: {what} {} under \
             {name}.",
            change(before, after, &unit)
        ),
    }
}

/// Maximum number of fitted channels that the first sentence of a report names, those with the largest relative error first.
const MOST_CHANNELS: usize = 4;

/// Describes the agreement with the record under the calibrated condition in an engineer's quantities: root mean square
/// and peak-to-peak error of the fitted channels, and the first quantity of the machine. `None` if a simulation or a score is
/// missing.
pub(crate) fn agreement(calibration: &Calibration, checks: &[MachineCheck]) -> Option<String> {
    let case = &calibration.case;
    let result = calibration.calibrated()?;
    let mut pairs: Vec<(&Channel, &ChannelScore, &ChannelScore)> = Vec::new();
    for after in &result.optimised.evaluation.channels {
        let before = score(&result.recommended.evaluation.channels, after.channel)?;
        let channel = case.channels.get(after.channel)?;
        if is_fitted(case, after.channel) && channel.limit.is_none() {
            pairs.push((channel, before, after));
        }
    }
    pairs.sort_by(|a, b| b.2.relative_error.total_cmp(&a.2.relative_error));
    let more = pairs.len().saturating_sub(MOST_CHANNELS);
    pairs.truncate(MOST_CHANNELS);
    if pairs.is_empty() {
        return None;
    }
    let list = |one: &dyn Fn(&(&Channel, &ChannelScore, &ChannelScore)) -> String| {
        join_words(&pairs.iter().map(one).collect::<Vec<_>>(), "and")
    };
    let errors = list(&|(channel, before, after)| {
        let unit = &channel.unit;
        let (before, after) = (
            significant(before.mse.sqrt()),
            quantity(after.mse.sqrt(), unit),
        );
        format!("{after} at {} ({before} before)", channel.title)
    });
    let peaks = list(&|(_, before, after)| {
        let [before, after] = [before, after].map(|score| percent(score.peak_to_peak_error));
        format!("{after} ({before} before)")
    });
    let peak = match pairs.len() {
        1 => "the peak-to-peak value is off by",
        _ => "the peak-to-peak values are off by",
    };
    let rest = match more {
        0 => String::new(),
        more => format!(" (of {more} more fitted channels the relative errors are smaller)"),
    };
    let name = condition_name(case, result.condition);
    // the first quantity of the machine is what it is judged by
    let machine = checks.iter().find(|check| check.condition == name);
    let machine = machine.and_then(|check| {
        let measured = check.measured?;
        let of = |value: Option<f64>| Some(percent(value? / measured - 1.0));
        let (before, after) = (of(check.before)?, of(check.after)?);
        Some(format!(
            "; the {} by {after} ({before} before)",
            check.quantity
        ))
    });
    let machine = machine.unwrap_or_default();
    Some(format!(
        "Under condition {name} the simulation misses the record by {errors}, root mean square{rest}; {peak} \
         {peaks}{machine}."
    ))
}

/// Formats the square of a unit with a leading space; empty where there is no unit.
pub fn square_after(unit: Option<&str>) -> String {
    match squared(unit).as_str() {
        "" => String::new(),
        square => format!(" {square}"),
    }
}

/// Formats the square of a channel's unit with a leading space.
fn square_of(case: &Case, channel: usize) -> String {
    square_after(
        case.channels
            .get(channel)
            .map(|channel| channel.unit.as_str()),
    )
}

/// Describes the objective in words, such as the sum of the mean squared errors of its channels.
fn objective(case: &Case) -> String {
    let terms = &case.objective.terms;
    let title = |term: &Term| {
        let mut channels = case.channels.iter();
        let found = channels.find(|channel| channel.name == term.channel);
        found.map_or_else(|| term.channel.clone(), |channel| channel.title.clone())
    };
    let titles: Vec<_> = terms.iter().map(title).collect();
    let weighted = terms.iter().any(|term| (term.weight - 1.0).abs() > 1e-12);
    let sum = if weighted { "weighted sum" } else { "sum" };
    match titles.as_slice() {
        [one] => format!("the mean squared error of {one}"),
        _ => format!(
            "the {sum} of the mean squared errors of {}",
            titles.join(" and ")
        ),
    }
}

/// Returns one sentence on the change of error for each channel of a condition; channels whose error rose are
/// marked as worse.
pub(crate) fn channels(case: &Case, result: &ConditionResult) -> Vec<String> {
    let before = &result.recommended.evaluation.channels;
    let after = &result.optimised.evaluation.channels;
    let calibrated = case.objective.holds(result.condition);
    let sentence = |new: &ChannelScore| {
        let role = if calibrated && !is_fitted(case, new.channel) {
            " (took no part in the fit)"
        } else {
            ""
        };
        let title = capitalised(&channel_title(case, new.channel));
        let unit = square_of(case, new.channel);
        match score(before, new.channel) {
            Some(old) => {
                let worse = if new.mse > old.mse { "worse: " } else { "" };
                format!(
                    "{title}{role}: {worse}mean squared error {}; relative error {} → {}.",
                    change(old.mse, new.mse, &unit),
                    percent(old.relative_error),
                    percent(new.relative_error),
                )
            }
            None => format!(
                "{title}{role}: mean squared error {}{unit}, relative error {}; no complete run \
                 with the recommended parameters to compare with.",
                significant(new.mse),
                percent(new.relative_error),
            ),
        }
    };
    after.iter().map(sentence).collect()
}

/// Returns a sentence about the channels whose absolute error rose although their error without offset fell,
/// which a free offset would hide; `None` if there are none.
pub(crate) fn absolute_worse(case: &Case, result: &ConditionResult) -> Option<String> {
    let before = &result.recommended.evaluation.channels;
    let changes: Vec<String> = result
        .optimised
        .evaluation
        .channels
        .iter()
        .filter_map(|new| {
            let old = score(before, new.channel)?;
            let (from, to) = (old.mse_fixed_offset, new.mse_fixed_offset);
            let hidden = new.mse < old.mse && to > from;
            let title = channel_title(case, new.channel);
            let unit = square_of(case, new.channel);
            hidden.then(|| format!("that of {title} {}", change(from, to, &unit)))
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

/// Ratio of an unknown to its recommended value, or its inverse, above which the unknown is reported as far
/// off.
const FAR: f64 = 30.0;

/// Describes a residual above the noise, the unknowns that may compensate for it, and the command that finds
/// the cause; `None` where the residual is at noise level or the noise is unknown.
pub(crate) fn model_error(calibration: &Calibration) -> Option<String> {
    let case = &calibration.case;
    let (channel, most) = times_noise(calibration)?;
    if most < NOISE_RATIO_LIMIT {
        return None;
    }
    let unknowns = case.unknowns.iter().zip(&calibration.optimised.genes);
    let far = unknowns.filter_map(|(unknown, value)| {
        let times = value / unknown.start;
        let is_far = !(1.0 / FAR..=FAR).contains(&times);
        let logarithmic = unknown.scale == Scale::Logarithmic;
        (is_far && logarithmic && is_determined(&calibration.identifiability, &unknown.name))
            .then(|| format!("{} at {}", unknown.name, ratio(*value, unknown.start)))
    });
    let far: Vec<String> = far.collect();
    let far = if far.is_empty() {
        String::new()
    } else {
        let all = join_words(&far, "and");
        format!(
            " Unknowns far from their recommended values may compensate for it, and then describe this fit, not the machine: {all} of the recommended value."
        )
    };
    Some(format!(
        "The fit leaves {} times the noise at {}: the model lacks an effect that these unknowns cannot represent.{far} \
         `horsehead diagnose {}` finds out what.",
        fixed(most, 1),
        channel.title,
        calibration.origin.run
    ))
}

/// Returns the fitted channel with the largest residual in terms of its noise, and that ratio; `None` where the
/// noise is unknown.
fn times_noise(calibration: &Calibration) -> Option<(&Channel, f64)> {
    let case = &calibration.case;
    let fitted = calibration.conditions.iter();
    let fitted = fitted.filter(|result| case.objective.holds(result.condition));
    let left = fitted.flat_map(|result| result.optimised.gaps(case, result.condition));
    let left = left.filter(|(channel, _)| case.objective.names(&channel.name));
    let left = left.filter_map(|(channel, gap)| Some((channel, gap.over_noise()?)));
    left.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns why the unknowns of a calibration have no intervals; `None` if they have.
pub(crate) fn lacks_intervals(calibration: &Calibration) -> Option<String> {
    let (_, most) = times_noise(calibration)?;
    (most >= NOISE_RATIO_LIMIT).then(|| no_intervals(most))
}

/// Returns the estimates of the unknowns whose intervals are shown: none where the fit leaves a multiple of the
/// noise.
pub fn intervals(calibration: &Calibration) -> &[UnknownEstimate] {
    match lacks_intervals(calibration) {
        Some(_) => &[],
        None => &calibration.identifiability,
    }
}

/// Returns the sentence on the missing intervals of a fit that leaves a multiple of the noise.
pub(crate) fn no_intervals(times_noise: f64) -> String {
    format!(
        "{} times the noise is left: the model lacks something, and no unknown has an interval before that is found.",
        fixed(times_noise, 1)
    )
}

/// States that the fit leaves no more than noise; `None` if it leaves more, or the noise is unknown.
pub(crate) fn noise_level(calibration: &Calibration) -> Option<String> {
    let (channel, most) = times_noise(calibration)?;
    (most < NOISE_RATIO_LIMIT).then(|| {
        format!(
            "What the fit leaves is at the level of the noise: {} times it at {}, the most of all fitted channels.",
            fixed(most, 1),
            channel.title
        )
    })
}

/// States that the search found fits of other families with nearly the same objective, and in which unknowns
/// they differ; `None` if it found none.
pub(crate) fn rivals(calibration: &Calibration) -> Option<String> {
    let case = &calibration.case;
    if calibration.rivals.is_empty() {
        return None;
    }
    let (_, best) = calibration.objective(|result| &result.optimised)?;
    let differs = |unknown: &&Unknown| {
        let mut rivals = calibration.rivals.iter();
        rivals.any(|rival| rival.differs.contains(&unknown.name))
    };
    let names = case.unknowns.iter().filter(differs);
    let names: Vec<String> = names.map(|unknown| unknown.name.clone()).collect();
    let unit = square_after(case.objective_unit());
    let rivals = calibration.rivals.iter();
    let objectives: Vec<String> = rivals.map(|rival| significant(rival.objective)).collect();
    let (fits, they) = match objectives.len() {
        1 => (
            "another fit, with an objective of",
            "It differs from the best one in",
        ),
        _ => (
            "other fits, with objectives of",
            "Each differs from the best one in some of",
        ),
    };
    Some(format!(
        "Several fits have nearly the same objective: the search also ended in {fits} {}{unit}; the best one has {}{unit}. \
         {they} {}; the values of all fits are under \"Parameters and errors\". An effect that the model lacks may \
         prefer the wrong one: trust none of these values before another condition confirms them.",
        join_words(&objectives, "and"),
        significant(best),
        join_words(&names, "and"),
    ))
}

/// Lists the warnings that follow from the data of a calibration: failed runs, worse channels, unknowns at a
/// bound.
pub(crate) fn warnings(calibration: &Calibration) -> Vec<String> {
    let case = &calibration.case;
    let mut warnings = Vec::new();
    for result in &calibration.conditions {
        let name = condition_name(case, result.condition);
        for (who, run) in [
            ("recommended", &result.recommended),
            ("optimised", &result.optimised),
        ] {
            if let failed @ Verdict::Failed { .. } = run.curves.verdict {
                warnings.push(format!(
                    "With the {who} parameters condition {name} {}; its curves end there.",
                    verdict(&failed)
                ));
            }
        }
        let before = &result.recommended.evaluation.channels;
        for new in &result.optimised.evaluation.channels {
            if score(before, new.channel).is_some_and(|old| new.mse > old.mse) {
                warnings.push(format!(
                    "{} is worse with the optimised parameters under condition {name}.",
                    capitalised(&channel_title(case, new.channel))
                ));
            }
        }
    }
    for (gene, &value) in case.unknowns.iter().zip(&calibration.optimised.genes) {
        if let Some(side) = at_bound(gene, value) {
            let mut said = calibration.identifiability.iter();
            let blind = said.any(|own| own.name == gene.name && own.seen == Determination::NotSeen);
            let (bound, value) = (bound(gene, side), quantity(value, &gene.unit));
            let near = if bound.ends_with(&value) {
                String::new()
            } else {
                format!(" ({value})")
            };
            warnings.push(format!(
                "{} ended at {bound}{near}: {}.",
                gene.name,
                if blind {
                    "near this value the record does not determine it, to first order; another value may fit better"
                } else {
                    "the optimum may lie outside, and the other values may compensate for that"
                }
            ));
        }
    }
    warnings
}

/// Returns the score of a channel, if there is one.
fn score(scores: &[ChannelScore], channel: usize) -> Option<&ChannelScore> {
    scores.iter().find(|score| score.channel == channel)
}
