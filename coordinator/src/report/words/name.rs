//! Names of things as people call them, and lists of names as a sentence has them.
use protocol::pumping_unit::ModeFamily;
use protocol::{case::Case, pumping_unit::Integrator};

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

/// Name of a condition; its number where the case does not have it.
pub(in crate::report) fn condition_name(case: &Case, condition: usize) -> String {
    case.conditions
        .get(condition)
        .map_or_else(|| format!("#{condition}"), |found| found.name.clone())
}

/// Title of a channel; its number where the case does not have it.
pub(in crate::report) fn channel_title(case: &Case, channel: usize) -> String {
    case.channels
        .get(channel)
        .map_or_else(|| format!("#{channel}"), |found| found.title.clone())
}

/// Whether the objective sums a channel.
pub(in crate::report) fn is_fitted(case: &Case, channel: usize) -> bool {
    let found = case.channels.get(channel);
    found.is_some_and(|channel| case.objective.names(&channel.name))
}

/// Items as a sentence lists them, as `a, b and c`.
pub(in crate::report) fn listed(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [all @ .., end] => format!("{} {last} {end}", all.join(", ")),
    }
}

/// A text with a capital at its start.
pub(in crate::report) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// A title within a sentence.
pub(in crate::report) fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}
