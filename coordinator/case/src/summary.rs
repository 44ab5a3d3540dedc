//! What `horsehead case check` tells about a case that is in order.
use super::{loaded::Loaded, note::Note};
use discrepancy::record::{Record, Recorded};
use std::fmt::Write as _;

/// A case in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Its name.
    pub name: String,
    /// Names of its conditions.
    pub conditions: Vec<String>,
    /// Key of the unknowns in objects.
    pub key: &'static str,
    /// Names of its unknowns.
    pub unknowns: Vec<String>,
    /// Remarks.
    pub notes: Vec<Note>,
    /// All of it, for people.
    pub text: String,
}

impl Summary {
    /// Of a case, with what is said of it.
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

/// What is stated of a channel's errors, and what of it is held out.
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

/// What a case says itself, of whatever kind its model is.
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
                |record| format!("measured in {} cycles", record.cycles),
            );
            let _infallible = writeln!(
                text,
                "  {}: {places} values over {} [{}], {recorded}{}",
                channel.title,
                channel.abscissa.name,
                channel.unit,
                stated(record, curve)
            );
        }
    }
    let terms = case.objective.terms.iter();
    let terms = terms.map(|term| format!("{} (weight {})", term.channel, term.weight));
    let terms: Vec<String> = terms.collect();
    let conditions = case.objective.conditions();
    let conditions = conditions.filter_map(|at| case.conditions.get(at));
    let conditions: Vec<&str> = conditions.map(|condition| &*condition.name).collect();
    let conditions = conditions.join(" + ");
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
