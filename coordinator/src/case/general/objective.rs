//! What a calibration minimises: channels of one condition, with weights.
use super::{
    super::{
        document::{Document, Step, nearest},
        error::CaseError,
    },
    channels::Read,
    file::{ConditionEntry, ObjectiveEntry, TermEntry},
};
use protocol::case::{Objective, Offset, Term};

/// The objective; a case that measures nothing needs none.
///
/// # Errors
/// A condition or channel that there is not or that is not measured, a weight that cannot be.
pub(super) fn read(
    document: &Document,
    entry: Option<&ObjectiveEntry>,
    conditions: &[ConditionEntry],
    channels: &[Read],
) -> Result<Objective, CaseError> {
    let measured = |read: &&Read| read.channel.record.is_some();
    let Some(entry) = entry else {
        return match channels.iter().find(measured) {
            None => Ok(Objective {
                condition: 0,
                terms: Vec::new(),
                offset: Offset::Free,
            }),
            Some(read) => Err(document.field(
                &[Step::Key("objective")],
                "absent",
                format!(
                    "a table, since channel `{}` has a record",
                    read.channel.name
                ),
                "add [objective] with condition, terms and offset",
            )),
        };
    };
    let names: Vec<&str> = conditions.iter().map(|it| it.name.as_str()).collect();
    let condition = names.iter().position(|name| *name == entry.condition);
    let condition = condition.ok_or_else(|| {
        let way = [Step::Key("objective"), Step::Key("condition")];
        unknown(document, &way, &entry.condition, "condition", &names)
    })?;
    if entry.terms.is_empty() {
        return Err(document.field(
            &[Step::Key("objective"), Step::Key("terms")],
            "[]",
            "at least one channel",
            "write terms = [{ channel = \"force\", weight = 1.0 }]",
        ));
    }
    let own: Vec<&Read> = channels
        .iter()
        .filter(|read| read.channel.condition == condition)
        .collect();
    for index in 0..entry.terms.len() {
        check_term(document, &entry.terms, index, &own)?;
    }
    let terms = entry.terms.iter().map(|term| Term {
        channel: term.channel.clone(),
        weight: term.weight,
    });
    Ok(Objective {
        condition,
        terms: terms.collect(),
        offset: entry.offset,
    })
}

/// A term names a measured channel of the condition, once, with a weight.
fn check_term(
    document: &Document,
    terms: &[TermEntry],
    index: usize,
    own: &[&Read],
) -> Result<(), CaseError> {
    let term = &terms[index];
    let way = |key| {
        let list = [Step::Key("objective"), Step::Key("terms")];
        [list[0], list[1], Step::Index(index), Step::Key(key)]
    };
    let quoted = format!("\"{}\"", term.channel);
    let found = own.iter().find(|read| read.channel.name == term.channel);
    let Some(found) = found else {
        let names: Vec<&str> = own.iter().map(|it| it.channel.name.as_str()).collect();
        return Err(unknown(
            document,
            &way("channel"),
            &term.channel,
            "channel",
            &names,
        ));
    };
    if found.channel.record.is_none() {
        return Err(document.field(
            &way("channel"),
            quoted,
            "a channel with a record",
            "there is nothing to compare with: add a record to it, or take another",
        ));
    }
    if terms[..index]
        .iter()
        .any(|other| other.channel == term.channel)
    {
        return Err(document.field(
            &way("channel"),
            quoted,
            "each channel once",
            "add the weights of the two",
        ));
    }
    if !(term.weight > 0.0 && term.weight.is_finite()) {
        return Err(document.field(
            &way("weight"),
            term.weight,
            "above 0",
            "leave a channel out that is not to count",
        ));
    }
    Ok(())
}

/// A name that nothing has.
fn unknown(
    document: &Document,
    way: &[Step<'_>],
    name: &str,
    what: &str,
    names: &[&str],
) -> CaseError {
    let near = nearest(name, names.iter().copied());
    document.field(
        way,
        format!("\"{name}\""),
        format!("the name of a {what}: {}", names.join(", ")),
        &near.map_or(format!("name one of them, or add a {what}"), |near| {
            format!("did you mean `{near}`?")
        }),
    )
}
