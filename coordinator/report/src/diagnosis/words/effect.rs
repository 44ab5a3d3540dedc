//! Sentences about effects and generic forces: their names and estimated sizes.
use crate::diagnosis::subject::DiagnosisInput;
use crate::number::interval;
use crate::number::quantity;
use crate::words::{join_words, lower};
use discrepancy::diagnose::Estimate;
use protocol::announce::Role;

/// Names an effect by its title followed by its identifier; the identifier alone if no worker describes the
/// effect.
pub(super) fn named(subject: &DiagnosisInput<'_>, id: &str) -> String {
    subject.effect(id).map_or_else(
        || id.to_owned(),
        |effect| format!("{} ({id})", lower(&effect.title)),
    )
}

/// Names a generic force by its title (kind and place of action) followed by its identifier.
pub(in crate::diagnosis) fn generic(subject: &DiagnosisInput<'_>, id: &str) -> String {
    subject.effect(id).map_or_else(
        || id.to_owned(),
        |force| format!("a {} ({id})", lower(&force.title)),
    )
}

/// Lists the size parameters of an effect with their 95 % intervals; shape parameters are left out.
fn sizes(subject: &DiagnosisInput<'_>, effect: &Estimate) -> String {
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
    join_words(&each, "and")
}

/// Lists the effects with their sizes, one item each; those that are not named are marked as suspected or as traces.
pub(in crate::diagnosis) fn effects(subject: &DiagnosisInput<'_>) -> Vec<String> {
    let diagnosis = subject.diagnosis();
    let one = |effect: &Estimate| {
        let suspected = if diagnosis.holds(&effect.id) {
            ""
        } else {
            "suspected, not named: "
        };
        format!("{suspected}{}: {}", effect.id, sizes(subject, effect))
    };
    let traces = diagnosis.traces().into_iter().map(|(effect, reason)| {
        let sizes = sizes(subject, effect);
        format!("trace, not named: {}: {sizes}; {reason}", effect.id)
    });
    diagnosis.effects.iter().map(one).chain(traces).collect()
}
