//! Effects and forces in words: their names, and the sizes that were found.
use super::value::interval;
use crate::diagnosis::subject::Subject;
use crate::number::quantity;
use crate::words::{listed, lower};
use discrepancy::diagnose::Estimate;
use discrepancy::verdict::Verdict;
use protocol::announce::Role;

/// An effect by its title, with the identifier behind it; the identifier alone where the workers do
/// not know it.
pub(super) fn named(subject: &Subject<'_>, id: &str) -> String {
    subject.effect(id).map_or_else(
        || id.to_owned(),
        |effect| format!("{} ({id})", lower(&effect.title)),
    )
}

/// A force without a cause: what it is and where it acts.
pub(in crate::diagnosis) fn generic(subject: &Subject<'_>, id: &str) -> String {
    subject.effect(id).map_or_else(
        || id.to_owned(),
        |force| format!("a {} ({id})", lower(&force.title)),
    )
}

/// The sizes of an effect with their intervals, shapes left out.
fn sizes(subject: &Subject<'_>, effect: &Estimate) -> String {
    let is_size = |name: &str| {
        let known = subject.parameter(&effect.id, name);
        known.is_none_or(|known| known.role == Role::Size)
    };
    let each: Vec<String> = effect
        .parameters
        .iter()
        .filter(|own| is_size(&own.name))
        .map(|own| {
            format!(
                "{} = {} (95\u{a0}% interval {})",
                own.name.replace('_', " "),
                quantity(own.value, &own.unit),
                interval(own.interval, &own.unit)
            )
        })
        .collect();
    listed(&each, "and")
}

/// Effects of the answer with their sizes, and what is only suspected as such: one item each.
pub(in crate::diagnosis) fn effects(subject: &Subject<'_>) -> Vec<String> {
    let unresolved = subject.diagnosis().verdict == Verdict::Unresolved;
    let suspected = if unresolved {
        "suspected, not named: "
    } else {
        ""
    };
    let each = subject.diagnosis().effects.iter();
    each.map(|effect| format!("{suspected}{}: {}", effect.id, sizes(subject, effect)))
        .collect()
}
