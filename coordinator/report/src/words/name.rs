//! Names of things as people call them, and lists of names as a sentence has them.
use crate::number::squared;
use protocol::case::{Abscissa, Case};

/// Name of a condition; its number where the case does not have it.
pub fn condition_name(case: &Case, condition: usize) -> String {
    case.conditions
        .get(condition)
        .map_or_else(|| format!("#{condition}"), |found| found.name.clone())
}

/// The conditions that are calibrated, as `condition 5rpm` or `conditions 5rpm and 4rpm`.
pub(crate) fn calibrated(case: &Case) -> String {
    let conditions = case.objective.conditions();
    let names: Vec<String> = conditions.map(|at| condition_name(case, at)).collect();
    let noun = if names.len() == 1 {
        "condition"
    } else {
        "conditions"
    };
    format!("{noun} {}", listed(&names, "and"))
}

/// Title of a channel; its number where the case does not have it.
pub(crate) fn channel_title(case: &Case, channel: usize) -> String {
    case.channels
        .get(channel)
        .map_or_else(|| format!("#{channel}"), |found| found.title.clone())
}

/// What is counted along an abscissa.
pub(crate) fn counted(abscissa: &Abscissa) -> String {
    let angle = if abscissa.unit == "deg" { " angle" } else { "" };
    format!("{}{angle}", abscissa.name)
}

/// A quantity with its unit in brackets behind it, where it has one.
pub(crate) fn headed(what: &str, unit: &str) -> String {
    match unit {
        "" => what.to_owned(),
        _ => format!("{what} [{unit}]"),
    }
}

/// The objective as scales and columns are headed.
pub(crate) fn objective_heading(case: &Case) -> String {
    headed("objective", &squared(case.objective_unit()))
}

/// Whether the objective sums a channel.
pub(crate) fn is_fitted(case: &Case, channel: usize) -> bool {
    let found = case.channels.get(channel);
    found.is_some_and(|channel| case.objective.names(&channel.name))
}

/// Items as a sentence lists them, as `a, b and c`.
pub(crate) fn listed(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [all @ .., end] => format!("{} {last} {end}", all.join(", ")),
    }
}

/// A text with a capital at its start.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// A title within a sentence.
pub(crate) fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}
