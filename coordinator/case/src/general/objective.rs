//! Reading of the objective that a calibration minimises: weighted channels of one or several conditions.
use super::{
    super::{
        document::{Document, DocumentStep, nearest},
        error::CaseError,
    },
    channels::ReadChannel,
    file::{ConditionEntry, ObjectiveEntry, TermEntry},
};
use protocol::case::{Objective, Term};

/// Reads the objective; a case without measured records needs none.
///
/// # Errors
/// Returns an error for a condition or channel that does not exist or has no record, and for an invalid
/// weight.
pub(super) fn read(
    document: &Document,
    entry: Option<&ObjectiveEntry>,
    conditions: &[ConditionEntry],
    channels: &[ReadChannel],
) -> Result<Objective, CaseError> {
    let measured = |read: &&ReadChannel| read.channel.record.is_some();
    let Some(entry) = entry else {
        return match channels.iter().find(measured) {
            None => Ok(Objective {
                condition: 0,
                others: Vec::new(),
                terms: Vec::new(),
            }),
            Some(read) => Err(document.field(
                &[DocumentStep::Key("objective")],
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
    let stated = conditions.iter().map(|it| (&*it.name, it.held_out));
    let (condition, others) = entry
        .condition
        .resolve(document, &stated.collect::<Vec<_>>())?;
    let fitted: Vec<usize> = std::iter::once(condition)
        .chain(others.iter().map(|other| other.condition))
        .collect();
    if entry.terms.is_empty() {
        return Err(document.field(
            &[DocumentStep::Key("objective"), DocumentStep::Key("terms")],
            "[]",
            "at least one channel",
            "write terms = [{ channel = \"force\", weight = 1.0 }]",
        ));
    }
    let own: Vec<&ReadChannel> = channels
        .iter()
        .filter(|read| fitted.contains(&read.channel.condition))
        .collect();
    for index in 0..entry.terms.len() {
        check_term(document, &entry.terms, index, &own)?;
    }
    check_measured(document, &entry.terms, (&fitted, &names), &own)?;
    let terms = entry.terms.iter().map(|term| Term {
        channel: term.channel.clone(),
        weight: term.weight,
    });
    Ok(Objective {
        condition,
        others,
        terms: terms.collect(),
    })
}

/// Checks that each condition of the objective has a measured record of at least one of the objective's
/// channels.
fn check_measured(
    document: &Document,
    terms: &[TermEntry],
    (fitted, names): (&[usize], &[&str]),
    own: &[&ReadChannel],
) -> Result<(), CaseError> {
    let summed = |read: &&&ReadChannel| {
        let is_named = |term: &TermEntry| term.channel == read.channel.name;
        read.channel.record.is_some() && terms.iter().any(is_named)
    };
    for (at, condition) in fitted.iter().enumerate() {
        let there = own.iter().filter(summed);
        if !there
            .map(|read| read.channel.condition)
            .any(|it| it == *condition)
        {
            return Err(document.field(
                &[
                    DocumentStep::Key("objective"),
                    DocumentStep::Key("condition"),
                    DocumentStep::Index(at),
                ],
                format!("\"{}\"", names[*condition]),
                "conditions with a record of one of the terms",
                "leave it out, or name one of its measured channels as a term",
            ));
        }
    }
    Ok(())
}

/// Checks that a term of the objective names a measured channel of the conditions, only once and with a
/// positive weight.
fn check_term(
    document: &Document,
    terms: &[TermEntry],
    index: usize,
    own: &[&ReadChannel],
) -> Result<(), CaseError> {
    let term = &terms[index];
    let keys = |key| {
        let list = [DocumentStep::Key("objective"), DocumentStep::Key("terms")];
        [
            list[0],
            list[1],
            DocumentStep::Index(index),
            DocumentStep::Key(key),
        ]
    };
    let quoted = format!("\"{}\"", term.channel);
    let called = |read: &&&ReadChannel| read.channel.name == term.channel;
    if !own.iter().any(|read| called(&read)) {
        let mut names: Vec<&str> = own.iter().map(|it| it.channel.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        return Err(unknown(
            document,
            &keys("channel"),
            &term.channel,
            "channel",
            &names,
        ));
    }
    let mut named = own.iter().filter(called);
    if named.all(|read| read.channel.record.is_none()) {
        return Err(document.field(
            &keys("channel"),
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
            &keys("channel"),
            quoted,
            "each channel once",
            "add the weights of the two",
        ));
    }
    if !(term.weight > 0.0 && term.weight.is_finite()) {
        return Err(document.field(
            &keys("weight"),
            term.weight,
            "above 0",
            "remove the term of a channel that is not part of the objective",
        ));
    }
    Ok(())
}

/// Builds the error for an unknown name, with the most similar known name as a suggestion.
fn unknown(
    document: &Document,
    keys: &[DocumentStep<'_>],
    name: &str,
    what: &str,
    names: &[&str],
) -> CaseError {
    let near = nearest(name, names.iter().copied());
    document.field(
        keys,
        format!("\"{name}\""),
        format!("the name of a {what}: {}", names.join(", ")),
        &near.map_or(format!("name one of them, or add a {what}"), |near| {
            format!("did you mean `{near}`?")
        }),
    )
}
