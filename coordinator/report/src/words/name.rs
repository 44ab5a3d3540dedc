//! Display names, and lists of names for sentences.
use crate::number::squared;
use protocol::case::{Abscissa, Case, WeightedCondition};

/// Returns the name of the condition with an index in the case; the index as text if the case lacks that
/// condition.
pub fn condition_name(case: &Case, condition: usize) -> String {
    case.conditions
        .get(condition)
        .map_or_else(|| format!("#{condition}"), |found| found.name.clone())
}

/// Names the calibrated conditions, as `condition 5rpm` or `conditions 5rpm and 4rpm (weight 0.5)`.
pub(crate) fn calibrated(case: &Case) -> String {
    let named = |one: WeightedCondition| {
        let name = condition_name(case, one.condition);
        if one.weight.total_cmp(&1.0).is_eq() {
            name
        } else {
            format!("{name} (weight {})", one.weight)
        }
    };
    let conditions = case.objective.weighted_conditions();
    let names: Vec<String> = conditions.map(named).collect();
    let noun = if names.len() == 1 {
        "condition"
    } else {
        "conditions"
    };
    format!("{noun} {}", join_words(&names, "and"))
}

/// Returns the title of the channel with an index in the case; the index as text if the case lacks that
/// channel.
pub(crate) fn channel_title(case: &Case, channel: usize) -> String {
    case.channels
        .get(channel)
        .map_or_else(|| format!("#{channel}"), |found| found.title.clone())
}

/// Returns the display name of the quantity along an abscissa, such as an angle or the time.
pub(crate) fn abscissa_quantity(abscissa: &Abscissa) -> String {
    let angle = if abscissa.unit == "deg" { " angle" } else { "" };
    format!("{}{angle}", abscissa.name)
}

/// Formats a quantity followed by its unit in brackets, if it has one.
pub(crate) fn with_unit(what: &str, unit: &str) -> String {
    match unit {
        "" => what.to_owned(),
        _ => format!("{what} [{unit}]"),
    }
}

/// Returns the heading of the objective for axes and columns, with its unit.
pub(crate) fn objective_heading(case: &Case) -> String {
    with_unit("objective", &squared(case.objective_unit()))
}

/// Returns whether a channel is part of the objective.
pub(crate) fn is_fitted(case: &Case, channel: usize) -> bool {
    let found = case.channels.get(channel);
    found.is_some_and(|channel| case.objective.names(&channel.name))
}

/// Joins items for a sentence, as `a, b and c` with `last` = "and".
pub(crate) fn join_words(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [all @ .., end] => format!("{} {last} {end}", all.join(", ")),
    }
}

/// Returns a text with its first letter in upper case.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// Returns a title with its first letter in lower case, for use within a sentence.
pub(crate) fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}
