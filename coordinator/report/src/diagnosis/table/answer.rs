//! Tables of the outcome of a diagnosis: parameters of the added effects, and unknowns of the case before and
//! after adding these effects.
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::{Row, Table};
use crate::number::interval;
use crate::number::{MISSING, quantity, significant};
use crate::words::at_bound;
use protocol::announce::{ParameterDescriptor, Role};

/// Builds the table of the parameters of the added effects; `None` if no effect was added.
pub(in crate::diagnosis) fn sizes(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let diagnosis = subject.diagnosis();
    // a suspect without a verdict is no answer
    subject.added().first()?;
    let mut rows = Vec::new();
    for effect in &diagnosis.effects {
        rows.push(Row::group(format!("{} ({})", effect.title, effect.id)));
        for own in &effect.parameters {
            let (name, unit) = (&own.name, &own.unit);
            let known = subject.parameter(&effect.id, name);
            let of = |value: Option<f64>| {
                value.map_or_else(|| MISSING.to_owned(), |value| quantity(value, unit))
            };
            rows.push(Row::new(
                name.replace('_', " "),
                [
                    quantity(own.value, unit),
                    interval(own.interval, unit),
                    of(known.map(usual)),
                    known.map_or_else(
                        || MISSING.to_owned(),
                        |p| interval([p.lower, p.upper], unit),
                    ),
                    known
                        .and_then(|p| edge(own.value, p.lower, p.upper))
                        .unwrap_or("")
                        .to_owned(),
                ],
            ));
        }
    }
    Table::new(
        "Sizes of the answer",
        [
            "",
            "value",
            "95\u{a0}% interval",
            "usual size",
            "bounds",
            "",
        ],
        rows,
    )
    .with_notes([
        "Intervals are those of the linearised fit with all genes free, as wide as its dispersion and the colour of what is left make them; \
             they hold if the name is right.",
    ])
    .non_empty()
}

/// Returns a typical value of an effect's parameter: its scale if it is a size parameter, its typical value
/// if it is a shape parameter.
fn usual(parameter: &ParameterDescriptor) -> f64 {
    match parameter.role {
        Role::Size => parameter.scale,
        Role::Shape => parameter.typical,
    }
}

/// Names the bound, of a linearly scaled parameter, within half a per cent of which its value lies, if any.
fn edge(value: f64, lower: f64, upper: f64) -> Option<&'static str> {
    let share = (value - lower) / (upper - lower);
    match share {
        _ if share < 0.005 => Some("at its lower bound"),
        _ if share > 0.995 => Some("at its upper bound"),
        _ => None,
    }
}

/// Builds the table of the case's unknowns, fitted without and with the added effects, with their bounds.
pub(in crate::diagnosis) fn genes(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let diagnosis = subject.diagnosis();
    let before = diagnosis.before.as_ref().map(|fit| &fit.genes)?;
    let after = diagnosis.after.as_ref().map(|fit| &fit.genes);
    let rows = subject.case.unknowns.iter().enumerate().map(|(k, gene)| {
        let of =
            |value: Option<&f64>| value.map_or_else(|| MISSING.to_owned(), |v| significant(*v));
        let last = after.unwrap_or(before).get(k);
        let edge = last.and_then(|v| at_bound(gene, *v));
        Row::of(
            gene,
            [
                significant(gene.start),
                of(before.get(k)),
                of(after.and_then(|after| after.get(k))),
                interval([gene.lower, gene.upper], &gene.unit),
                edge.map_or_else(String::new, |edge| format!("at its {edge} bound")),
            ],
        )
    });
    Some(Table::new(
        "Parameters of the calibration",
        [
            "",
            "recommended",
            "recalibrated",
            "with the answer",
            "bounds",
            "",
        ],
        rows.collect(),
    ))
}
