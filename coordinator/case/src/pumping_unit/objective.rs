//! Reading of the objective that a calibration minimises: conditions and weighted gauges.
use super::record::RecordFacts;
use super::schema::{ConditionEntry, GaugeWeight, ObjectiveEntry};
use crate::{
    document::{Document, DocumentStep},
    error::CaseError,
    note::Note,
    table::clip,
};
use protocol::case::{Channel, Objective, Offset, Term};
use protocol::pumping_unit::Sensor;

/// Reads the objective, with its conditions by index. A case without gauge records needs none, because it is
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
                terms: (1..=4)
                    .map(|gauge| term(Sensor::Gauge(gauge), 1.0))
                    .collect(),
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
    let names = conditions.iter().map(|own| (own.name.as_str(), false));
    let (condition, others) = entry
        .condition
        .resolve(document, &names.collect::<Vec<_>>())?;
    let objective = Objective {
        condition,
        others,
        terms: stated_terms(entry)
            .into_iter()
            .map(|own| own.term)
            .collect(),
    };
    let bare = objective
        .conditions()
        .filter_map(|at| conditions.get(at))
        .find(|own| own.record_file.is_none());
    if let (Some(_), Some(bare)) = (recorded, bare) {
        return Err(document.field(
            &[
                DocumentStep::Key("objective"),
                DocumentStep::Key("condition"),
            ],
            format!("\"{}\"", bare.name),
            "a condition with a record_file",
            "there is nothing to compare with: add record_file to the condition, or take another",
        ));
    }
    check_gauges(document, &entry.gauges)?;
    for (key, weight) in [
        (POSITION, entry.position_weight_mpa2_per_m2),
        (TORQUE, entry.torque_weight_mpa2_per_kn2_m2),
    ] {
        if let Some(weight) = weight.filter(|weight| !(*weight > 0.0 && *weight <= 1.0e9)) {
            return Err(document.field(
                &["objective", key].map(DocumentStep::Key),
                weight,
                "above 0, at most 1e9",
                "remove the key if it is not part of the objective",
            ));
        }
    }
    Ok(objective)
}

/// Key of the weight of the rod position.
const POSITION: &str = "position_weight_mpa2_per_m2";
/// Key of the weight of the crank torque.
const TORQUE: &str = "torque_weight_mpa2_per_kn2_m2";

/// Square newton metres in a square kilonewton metre.
const KILO_SQUARED: f64 = 1.0e6;

/// Term of the objective as the case file states it.
struct StatedTerm {
    term: Term,
    /// Whether the term is dropped if the record lacks its channel.
    optional: bool,
    /// Path to the key that states the term.
    keys: Vec<DocumentStep<'static>>,
    /// Value of that key.
    value: String,
    /// Column of the record from which the channel is read.
    column: String,
}

/// Returns the terms that the case file states: gauges, rod position, crank torque.
fn stated_terms(entry: &ObjectiveEntry) -> Vec<StatedTerm> {
    let gauge = |(at, own): (usize, &GaugeWeight)| StatedTerm {
        term: term(Sensor::Gauge(own.gauge), own.weight),
        optional: own.optional,
        keys: vec![
            DocumentStep::Key("objective"),
            DocumentStep::Key("gauges"),
            DocumentStep::Index(at),
            DocumentStep::Key("gauge"),
        ],
        value: own.gauge.to_string(),
        column: format!("stress_{}_mpa", own.gauge),
    };
    let other = |sensor, key, (weight, unit): (Option<f64>, f64), column: &str| {
        weight.map(|weight| StatedTerm {
            term: term(sensor, weight / unit),
            optional: false,
            keys: vec![DocumentStep::Key("objective"), DocumentStep::Key(key)],
            value: weight.to_string(),
            column: column.to_owned(),
        })
    };
    let position = (entry.position_weight_mpa2_per_m2, 1.0);
    let torque = (entry.torque_weight_mpa2_per_kn2_m2, KILO_SQUARED);
    let gauges = entry.gauges.iter().enumerate().map(gauge);
    gauges
        .chain(other(
            Sensor::Position,
            POSITION,
            position,
            "polished_rod_position_m",
        ))
        .chain(other(Sensor::Torque, TORQUE, torque, "crank_torque_nm"))
        .collect()
}

/// Returns the channels with the treatment of their sensors' zero: that of the gauges as the objective states it; the
/// zero of the rod position is where the sensor was mounted, that of the torque is absolute.
pub(super) fn with_offset(
    entry: Option<&ObjectiveEntry>,
    channels: Vec<Channel>,
) -> impl Iterator<Item = Channel> {
    let offset = entry.map(|entry| entry.offset).unwrap_or_default();
    channels.into_iter().map(move |own| {
        let offset = match Sensor::named(&own.name) {
            Some(Sensor::Position) => Offset::Free,
            Some(Sensor::Torque) => Offset::Fixed,
            Some(Sensor::Gauge(_)) | None => offset,
        };
        Channel { offset, ..own }
    })
}

/// Restricts the objective to the channels that the records of its conditions contain, provided the others are
/// optional: one that one of several records lacks counts under the other conditions, one that all lack is
/// dropped. Returns notes on the restriction.
///
/// # Errors
/// Returns an error for a record that lacks a required gauge, or all gauges of the objective.
pub(super) fn restrict_to_recorded(
    document: &Document,
    entry: Option<&ObjectiveEntry>,
    objective: &mut Objective,
    (names, channels, facts): (&[&str], &[Channel], &[Option<RecordFacts>]),
) -> Result<Vec<Note>, CaseError> {
    let note = |text: String| Note {
        path: document.path.clone(),
        text,
    };
    let Some(entry) = entry else {
        let text =
            "no [objective]: the case is simulated only; a calibration needs one, and a record";
        return Ok(vec![note(text.to_owned())]);
    };
    let stated = stated_terms(entry);
    let mut notes = Vec::new();
    let mut found_anywhere = vec![false; objective.terms.len()];
    for condition in objective.conditions() {
        let own = channels.iter().filter(|own| own.condition == condition);
        let recorded: Vec<&str> = own
            .filter(|own| own.record.is_some())
            .map(|own| &*own.name)
            .collect();
        if recorded.is_empty() {
            // simulated only: there is no record to lack a gauge
            return Ok(notes);
        }
        let terms = objective.terms.iter();
        let there: Vec<bool> = terms
            .map(|term| recorded.contains(&&*term.channel))
            .collect();
        let kept = there.contains(&true);
        let mut pairs = there.iter().zip(&stated);
        let lost = pairs.find(|(there, own)| !**there && (!kept || !own.optional));
        if let Some((_, lost)) = lost {
            let facts = facts.get(condition).and_then(Option::as_ref);
            let unused = facts.map_or(&[][..], |facts| &facts.unused);
            return Err(missing_channel(document, lost, &recorded, unused));
        }
        let missing = objective.terms.iter().zip(&there);
        let missing = missing.filter(|(_, there)| !**there);
        let missing: Vec<&str> = missing.map(|(term, _)| &*term.channel).collect();
        if !missing.is_empty() {
            let kept = objective.terms.iter().zip(&there);
            let kept = kept.filter(|(_, there)| **there);
            let kept: Vec<&str> = kept.map(|(term, _)| &*term.channel).collect();
            let (missing, kept) = (missing.join(", "), kept.join(", "));
            notes.push(note(if objective.others.is_empty() {
                format!("the record lacks {missing}: the objective is taken over {kept}")
            } else {
                let name = names.get(condition).copied().unwrap_or_default();
                format!(
                    "the record of condition `{name}` lacks {missing}: it is compared over {kept}"
                )
            }));
        }
        for (found, there) in found_anywhere.iter_mut().zip(there) {
            *found |= there;
        }
    }
    let mut found = found_anywhere.into_iter();
    objective.terms.retain(|_| found.next().unwrap_or(true));
    Ok(notes)
}

/// Builds the error for a channel of the objective that a record lacks; `recorded` are the channels that the
/// record has, `unused` its columns that are not read.
fn missing_channel(
    document: &Document,
    lost: &StatedTerm,
    recorded: &[&str],
    unused: &[String],
) -> CaseError {
    let unused = if unused.is_empty() {
        String::new()
    } else {
        format!(" (not used there: {})", clip(&unused.join(", "), 120))
    };
    let without = match Sensor::gauge(&lost.term.channel) {
        Some(gauge) => format!(
            "say that the objective may do without it: {{ gauge = {gauge}, weight = 1.0, optional = true }}"
        ),
        None => "remove the key".to_owned(),
    };
    let column = &lost.column;
    document.field(
        &lost.keys,
        &lost.value,
        format!("a channel that the record has: {}", recorded.join(", ")),
        &format!("name its column {column}{unused}; or {without}"),
    )
}

fn term(sensor: Sensor, weight: f64) -> Term {
    Term {
        channel: sensor.name(),
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
        let keys = |key| {
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
                &keys("gauge"),
                part.gauge,
                "1 to 4, each once",
                "gauges are numbered as in the record's columns stress_1_mpa .. stress_4_mpa",
            ));
        }
        if !(part.weight > 0.0 && part.weight <= 1.0e6) {
            return Err(document.field(
                &keys("weight"),
                part.weight,
                "above 0, at most 1e6",
                "remove a gauge that is not part of the objective",
            ));
        }
    }
    Ok(())
}
