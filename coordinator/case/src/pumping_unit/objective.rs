//! Reading of the objective that a calibration minimises: a condition and weighted gauges.
use super::record::RecordFacts;
use super::schema::{ConditionEntry, GaugeWeight, ObjectiveEntry};
use crate::{
    document::{Document, DocumentStep, nearest},
    error::CaseError,
    note::Note,
    table::clip,
};
use protocol::case::{Channel, Objective, Term};
use protocol::pumping_unit::Sensor;

/// Reads the objective, with its condition by index. A case without gauge records needs none, because it is
/// only simulated.
///
/// # Errors
/// Returns an error for an unknown condition or gauge, and for a condition without a record if other
/// conditions have one.
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
                &[DocumentStep::Key("objective")],
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
    let way = |key| [DocumentStep::Key("objective"), DocumentStep::Key(key)];
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

/// Returns the channels with the treatment of the sensor's zero (free or fixed offset) that the objective
/// states.
pub(super) fn with_offset(
    entry: Option<&ObjectiveEntry>,
    channels: Vec<Channel>,
) -> impl Iterator<Item = Channel> {
    let offset = entry.map(|entry| entry.offset).unwrap_or_default();
    channels
        .into_iter()
        .map(move |own| Channel { offset, ..own })
}

/// Restricts the objective to the gauges that its condition's record contains, provided the others are
/// optional. Returns a note on the restriction; `None` if the record contains all of them.
///
/// # Errors
/// Returns an error for a record that lacks a required gauge, or all gauges of the objective.
pub(super) fn restrict_to_recorded(
    document: &Document,
    entry: Option<&ObjectiveEntry>,
    objective: &mut Objective,
    (channels, facts): (&[Channel], &[Option<RecordFacts>]),
) -> Result<Option<Note>, CaseError> {
    let note = |text: String| Note {
        path: document.path.clone(),
        text,
    };
    if entry.is_none() {
        let text =
            "no [objective]: the case is simulated only; a calibration needs one, and a record";
        return Ok(Some(note(text.to_owned())));
    }
    let own = facts.get(objective.condition).and_then(Option::as_ref);
    let unused = own.map_or(&[][..], |facts| &facts.unused);
    let own = channels
        .iter()
        .filter(|own| own.condition == objective.condition);
    let recorded: Vec<&Channel> = own.filter(|own| own.record.is_some()).collect();
    let there = |term: &Term| recorded.iter().any(|own| own.name == term.channel);
    let gauges = entry.iter().flat_map(|entry| &entry.gauges);
    let gauges: Vec<&GaugeWeight> = gauges.collect();
    let kept = objective.terms.iter().any(there);
    let needed = |at: usize| !kept || gauges.get(at).is_some_and(|gauge| !gauge.optional);
    let mut terms = objective.terms.iter().enumerate();
    let lost = terms.find(|(at, term)| !there(term) && needed(*at));
    if recorded.is_empty() || objective.terms.iter().all(there) {
        return Ok(None);
    }
    let names = |all: &mut dyn Iterator<Item = &str>| all.collect::<Vec<_>>().join(", ");
    let found = names(&mut recorded.iter().map(|own| &*own.name));
    if let Some((at, _)) = lost {
        let gauge = gauges.get(at).map_or(0, |gauge| gauge.gauge);
        let step = |key| {
            [
                DocumentStep::Key("objective"),
                DocumentStep::Key("gauges"),
                DocumentStep::Index(at),
                DocumentStep::Key(key),
            ]
        };
        return Err(document.field(
            &step("gauge"),
            gauge,
            format!("a gauge that the record has: {found}"),
            &format!(
                "name its column stress_{gauge}_mpa{}; or say that the objective may do without it: \
                 {{ gauge = {gauge}, weight = 1.0, optional = true }}",
                if unused.is_empty() {
                    String::new()
                } else {
                    format!(" (not used there: {})", clip(&unused.join(", "), 120))
                }
            ),
        ));
    }
    let (kept, lost): (Vec<Term>, Vec<Term>) = std::mem::take(&mut objective.terms)
        .into_iter()
        .partition(there);
    objective.terms = kept;
    Ok(Some(note(format!(
        "the record lacks {}: the objective is taken over {}",
        names(&mut lost.iter().map(|term| &*term.channel)),
        names(&mut objective.terms.iter().map(|term| &*term.channel)),
    ))))
}

fn term(gauge: u8, weight: f64) -> Term {
    Term {
        channel: Sensor::Gauge(gauge).name(),
        weight,
    }
}

/// Checks that the gauges are 1 to 4, each once, with positive weights.
fn check_gauges(document: &Document, gauges: &[GaugeWeight]) -> Result<(), CaseError> {
    if gauges.is_empty() {
        return Err(document.field(
            &[DocumentStep::Key("objective"), DocumentStep::Key("gauges")],
            "[]",
            "at least one gauge",
            "write gauges = [{ gauge = 1, weight = 1.0 }]",
        ));
    }
    for (index, part) in gauges.iter().enumerate() {
        let way = |key| {
            [
                DocumentStep::Key("objective"),
                DocumentStep::Key("gauges"),
                DocumentStep::Index(index),
                DocumentStep::Key(key),
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
                "remove a gauge that is not part of the objective",
            ));
        }
    }
    Ok(())
}
