//! What a case asks a calibration to minimise: which condition, and which gauges.
use super::schema::{ConditionEntry, GaugeWeight, ObjectiveEntry};
use crate::case::{
    document::{Document, Step, nearest},
    error::CaseError,
};
use protocol::case::{Channel, Objective, Term};
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
                others: Vec::new(),
                terms: (1..=4).map(|gauge| term(gauge, 1.0)).collect(),
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
        others: Vec::new(),
        terms: entry
            .gauges
            .iter()
            .map(|part| term(part.gauge, part.weight))
            .collect(),
    })
}

/// Channels with the zero that the objective says they have.
pub(super) fn with_offset(
    entry: Option<&ObjectiveEntry>,
    channels: Vec<Channel>,
) -> impl Iterator<Item = Channel> {
    let offset = entry.map(|entry| entry.offset).unwrap_or_default();
    channels
        .into_iter()
        .map(move |own| Channel { offset, ..own })
}

/// Takes the objective over those of its gauges that its condition's record has; over all that were
/// measured if it has none of them. Says so; none where there is nothing to say.
pub(super) fn over_recorded(objective: &mut Objective, channels: &[Channel]) -> Option<String> {
    let own = channels
        .iter()
        .filter(|own| own.condition == objective.condition);
    let recorded: Vec<&Channel> = own.filter(|own| own.record.is_some()).collect();
    let there = |term: &Term| recorded.iter().any(|own| own.name == term.channel);
    if recorded.is_empty() || objective.terms.iter().all(there) {
        return None;
    }
    let (kept, lost): (Vec<Term>, Vec<Term>) = std::mem::take(&mut objective.terms)
        .into_iter()
        .partition(there);
    let without: Vec<&str> = lost.iter().map(|term| &*term.channel).collect();
    let all = || {
        recorded.iter().map(|own| Term {
            channel: own.name.clone(),
            weight: 1.0,
        })
    };
    objective.terms = if kept.is_empty() {
        all().collect()
    } else {
        kept
    };
    let over: Vec<&str> = objective.terms.iter().map(|term| &*term.channel).collect();
    Some(format!(
        "the record lacks {}: the objective is taken over {}",
        without.join(", "),
        over.join(", ")
    ))
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

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::ChannelRecord;

    #[test]
    fn an_objective_is_taken_over_the_gauges_that_are_there() {
        let over = |gauges: &[u8]| {
            let channel = |sensor: Sensor| {
                let mut own = sensor.channel(0, vec![0.0, 180.0]);
                own.record =
                    gauges
                        .iter()
                        .any(|g| Sensor::Gauge(*g) == sensor)
                        .then(|| ChannelRecord {
                            cycles: 5,
                            mean: vec![0.0; 2],
                            spread: vec![0.0; 2],
                        });
                own
            };
            let mut objective = Objective {
                condition: 0,
                others: Vec::new(),
                terms: vec![term(1, 1.0), term(3, 2.0)],
            };
            let said = over_recorded(&mut objective, &Sensor::ALL.map(channel));
            let terms = objective.terms.iter();
            let terms: Vec<(String, f64)> = terms.map(|t| (t.channel.clone(), t.weight)).collect();
            (terms, said)
        };
        let named = |all: &[(u8, f64)]| -> Vec<(String, f64)> {
            all.iter()
                .map(|(g, w)| (Sensor::Gauge(*g).name(), *w))
                .collect()
        };
        assert_eq!(over(&[1, 2, 3]), (named(&[(1, 1.0), (3, 2.0)]), None));
        let (terms, said) = over(&[3, 4]);
        assert_eq!(terms, named(&[(3, 2.0)]));
        assert!(said.unwrap().contains("gauge_1"));
        assert_eq!(over(&[2, 4]).0, named(&[(2, 1.0), (4, 1.0)]));
        // no record at all: nothing to take it over
        assert_eq!(over(&[]), (named(&[(1, 1.0), (3, 2.0)]), None));
    }
}
