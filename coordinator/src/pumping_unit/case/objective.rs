//! What a case asks a calibration to minimise: which condition, and which gauges.
use super::schema::{ConditionEntry, GaugeWeight, ObjectiveEntry};
use crate::case::{
    document::{Document, Step, nearest},
    error::CaseError,
};
use protocol::case::{Objective, Offset, Term};
use protocol::pumping_unit::Sensor;

/// The objective, with its condition by index. A case without gauge records needs none: it has nothing
/// to compare with, and is simulated.
///
/// # Errors
/// A condition or a gauge that there is not, or a condition without a record where others have one.
pub(super) fn read(
    document: &Document,
    entry: Option<&ObjectiveEntry>,
    conditions: &[ConditionEntry],
) -> Result<Objective, CaseError> {
    let recorded = conditions.iter().find(|entry| entry.record_file.is_some());
    let Some(entry) = entry else {
        return match recorded {
            None => Ok(Objective {
                condition: 0,
                terms: (1..=4).map(|gauge| term(gauge, 1.0)).collect(),
                offset: Offset::Free,
            }),
            Some(recorded) => Err(document.field(
                &[Step::Key("objective")],
                "absent",
                format!(
                    "a table, since condition `{}` has a record_file",
                    recorded.name
                ),
                "add [objective] with condition, gauges and offset; `horsehead case new` shows one",
            )),
        };
    };
    let names = conditions.iter().map(|condition| condition.name.as_str());
    let list: Vec<&str> = names.clone().collect();
    let way = |key| [Step::Key("objective"), Step::Key(key)];
    let Some(condition) = names.clone().position(|name| name == entry.condition) else {
        return Err(document.field(
            &way("condition"),
            format!("\"{}\"", entry.condition),
            format!("the name of a condition: {}", list.join(", ")),
            &nearest(&entry.condition, names)
                .map_or("name one of the conditions".to_owned(), |near| {
                    format!("did you mean `{near}`?")
                }),
        ));
    };
    let bare = |entry: &ConditionEntry| entry.record_file.is_none();
    if recorded.is_some() && conditions.get(condition).is_some_and(bare) {
        return Err(document.field(
            &way("condition"),
            format!("\"{}\"", entry.condition),
            "a condition with a record_file",
            "there is nothing to compare with: add record_file to the condition, or take another",
        ));
    }
    check_gauges(document, &entry.gauges)?;
    Ok(Objective {
        condition,
        terms: entry
            .gauges
            .iter()
            .map(|part| term(part.gauge, part.weight))
            .collect(),
        offset: entry.offset,
    })
}

fn term(gauge: u8, weight: f64) -> Term {
    Term {
        channel: Sensor::Gauge(gauge).name(),
        weight,
    }
}

/// Gauges that there are, each once, with weights above 0.
fn check_gauges(document: &Document, gauges: &[GaugeWeight]) -> Result<(), CaseError> {
    if gauges.is_empty() {
        return Err(document.field(
            &[Step::Key("objective"), Step::Key("gauges")],
            "[]",
            "at least one gauge",
            "write gauges = [{ gauge = 1, weight = 1.0 }]",
        ));
    }
    for (index, part) in gauges.iter().enumerate() {
        let way = |key| {
            [
                Step::Key("objective"),
                Step::Key("gauges"),
                Step::Index(index),
                Step::Key(key),
            ]
        };
        let twice = gauges
            .iter()
            .take(index)
            .any(|other| other.gauge == part.gauge);
        if !(1..=4).contains(&part.gauge) || twice {
            return Err(document.field(
                &way("gauge"),
                part.gauge,
                "1 to 4, each once",
                "gauges are numbered as in the record's columns stress_1_mpa .. stress_4_mpa",
            ));
        }
        if !(part.weight > 0.0 && part.weight <= 1.0e6) {
            return Err(document.field(
                &way("weight"),
                part.weight,
                "above 0, at most 1e6",
                "leave a gauge out that is not to count",
            ));
        }
    }
    Ok(())
}
