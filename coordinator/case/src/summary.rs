//! Summary that `horsehead case check` prints of a valid case.
use super::{loaded::Loaded, note::Note};
use protocol::case::{Case, WeightedCondition};
use record::{Record, Recorded};
use std::fmt::Write as _;

/// Summary of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseSummary {
    /// Name of the case.
    pub name: String,
    /// Names of the conditions.
    pub conditions: Vec<String>,
    /// JSON key under which a set of values of the unknowns is written.
    pub key: &'static str,
    /// Names of the unknowns.
    pub unknowns: Vec<String>,
    /// Remarks about the case.
    pub notes: Vec<Note>,
    /// Human-readable text of the whole summary.
    pub text: String,
}

impl CaseSummary {
    /// Creates the summary of a case with the given text.
    pub fn new(loaded: &Loaded, key: &'static str, text: String) -> Self {
        let case = &loaded.case;
        Self {
            key,
            name: case.name.clone(),
            conditions: case.conditions.iter().map(|one| one.name.clone()).collect(),
            unknowns: case.unknowns.iter().map(|one| one.name.clone()).collect(),
            notes: loaded.notes.clone(),
            text,
        }
    }
}

/// Describes the stated errors of a channel (noise, correlation, model error) and its held-out part.
fn stated(record: Option<&Record>, curve: usize) -> String {
    let parts = record.iter().flat_map(|record| &record.channels);
    let parts: Vec<&Recorded> = parts.filter(|own| own.curve == curve).collect();
    let Some(own) = parts.first() else {
        return String::new();
    };
    let unit = &own.channel.unit;
    let mut said = Vec::new();
    said.extend(
        own.channel
            .noise
            .map(|noise| format!("noise {noise} {unit}")),
    );
    said.extend(own.correlation.map(|rho| format!("correlation {rho:.3}")));
    said.extend(
        own.model_error
            .map(|error| format!("model error {error} {unit}")),
    );
    if let Some(held) = parts.iter().find(|own| own.held_out) {
        let part = held
            .rows
            .as_ref()
            .map(|rows| format!("{} values held out", rows.len()));
        said.push(part.unwrap_or_else(|| "held out".to_owned()));
    }
    // a comma before the first as well
    said.insert(0, String::new());
    said.join(", ")
}

/// Describes the parts of a case that every kind of model has.
pub fn text(loaded: &Loaded) -> String {
    let case = &loaded.case;
    let mut text = format!("model       {} ({})\n", case.name, case.model.kind);
    let names = case.unknowns.iter().map(|unknown| unknown.name.len());
    let width = names.fold(6, usize::max);
    text.push_str("unknowns    start (lower .. upper)\n");
    for unknown in &case.unknowns {
        let (name, unit, start) = (&unknown.name, &unknown.unit, unknown.start);
        let searched = match &unknown.tie {
            Some(tie) => format!("always {} of {}", tie.ratio, tie.to),
            None if unknown.fixed => "known".to_owned(),
            None => format!("{:.2e} .. {:.2e}", unknown.lower, unknown.upper),
        };
        let off = match &unknown.suspect {
            _ if !unknown.is_off() => String::new(),
            Some(group) => format!(", off, suspected with {group}"),
            None => ", off".to_owned(),
        };
        let _infallible = writeln!(
            text,
            "  {name:<width$} {start:>10.3e} ({searched}{off}) {unit}"
        );
    }
    for effect in &loaded.effects {
        let numbers = effect.parameters.iter();
        let numbers = numbers.map(|(name, p)| format!("{name} {} {}", p.value, p.unit));
        let numbers: Vec<String> = numbers.collect();
        let _infallible = writeln!(text, "effect      {}: {}", effect.id, numbers.join(", "));
    }
    for (index, condition) in case.conditions.iter().enumerate() {
        let record = loaded.cycles.iter().find(|own| own.condition == index);
        let held_out = if record.is_some_and(|record| record.held_out) {
            " (held out)"
        } else {
            ""
        };
        let _infallible = writeln!(text, "condition   {}{held_out}", condition.name);
        for (curve, (_, channel)) in case.channels_of(index).enumerate() {
            let places = channel.abscissa.points.len();
            let recorded = channel.record.as_ref().map_or_else(
                || "not measured".to_owned(),
                |record| match record.cycles {
                    1 => "measured in one cycle".to_owned(),
                    cycles => format!("measured in {cycles} cycles"),
                },
            );
            let _infallible = writeln!(
                text,
                "  {} [{}]: {places} values over {} [{}], {recorded}{}",
                channel.title,
                channel.unit,
                channel.abscissa.name,
                channel.abscissa.unit,
                stated(record, curve)
            );
        }
    }
    let terms = case.objective.terms.iter();
    let terms = terms.map(|term| format!("{} (weight {})", term.channel, term.weight));
    let terms: Vec<String> = terms.collect();
    let conditions = calibrated_conditions(case);
    if terms.is_empty() {
        text.push_str("objective   none: the case is simulated only");
    } else {
        let _infallible = write!(text, "objective   {conditions}: {}", terms.join(", "));
    }
    for note in &loaded.notes {
        let _infallible = write!(text, "\nnote: {note}");
    }
    text
}

/// Names the calibrated conditions of a case with their weights, as `5rpm + 0.5 x 4rpm`.
pub(crate) fn calibrated_conditions(case: &Case) -> String {
    let named = |one: WeightedCondition| {
        let name = &case.conditions.get(one.condition)?.name;
        Some(if one.weight.total_cmp(&1.0).is_eq() {
            name.clone()
        } else {
            format!("{} x {name}", one.weight)
        })
    };
    let conditions = case.objective.weighted_conditions();
    let conditions: Vec<String> = conditions.filter_map(named).collect();
    conditions.join(" + ")
}
