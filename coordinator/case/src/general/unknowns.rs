//! Reading of the unknowns, with the location of errors in the case file.
use super::{
    super::{
        document::{Document, DocumentStep},
        error::CaseError,
        names,
    },
    file::UnknownEntry,
};
use protocol::case::{Scale, Unknown, check_unknowns};

/// Reads the unknowns of a case file.
///
/// # Errors
/// Returns an error for a name with characters that are not allowed, a duplicate name, and everything that
/// [`check_unknowns`] refuses.
pub(super) fn read(
    document: &Document,
    entries: &[UnknownEntry],
) -> Result<Vec<Unknown>, CaseError> {
    let all: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
    names::check_program_names(document, "unknowns", "unknown", &all)?;
    let keys = |index, field| {
        [
            DocumentStep::Key("unknowns"),
            DocumentStep::Index(index),
            DocumentStep::Key(field),
        ]
    };
    let unknowns = entries.iter().enumerate().map(|(index, entry)| {
        let mut own = unknown(entry, start(entry, entries, entries.len()));
        if let Some(prior) = entry.prior {
            own.prior = Some(prior.of(&own, document, &keys(index, "prior"))?);
        }
        Ok(own)
    });
    let unknowns = unknowns.collect::<Result<Vec<Unknown>, CaseError>>()?;
    check_unknowns(&unknowns).map_err(|bad| {
        let keys = keys(bad.position, bad.field);
        document.field(&keys, bad.found, bad.allowed, bad.remedy)
    })?;
    Ok(unknowns)
}

fn unknown(entry: &UnknownEntry, start: f64) -> Unknown {
    let or_name = |text: &Option<String>| text.clone().unwrap_or_else(|| entry.name.clone());
    Unknown {
        name: entry.name.clone(),
        title: or_name(&entry.title),
        symbol: or_name(&entry.symbol),
        unit: entry.unit.clone(),
        scale: entry.scale,
        start,
        // what is held or follows needs no bounds
        lower: entry.lower.unwrap_or(start),
        upper: entry.upper.unwrap_or(start),
        trust: entry.trust,
        valley: entry.valley.clone(),
        prior: None,
        absent: entry.absent,
        fixed: entry.fixed,
        tie: entry.tie.clone(),
        step: entry
            .difference
            .map(|difference| difference_step(entry, difference)),
        suspect: entry.suspect.clone(),
        is_effect: false,
    }
}

/// Returns the start value of an unknown: the stated one, or that of the unknown to which it is tied times
/// the ratio. `ties` limits the depth of the recursion, in case ties form a loop.
fn start(entry: &UnknownEntry, all: &[UnknownEntry], ties: usize) -> f64 {
    let tie = entry.tie.as_ref().filter(|_| ties > 0);
    let tied = || {
        let tie = tie?;
        let other = all.iter().find(|other| other.name == tie.to)?;
        Some(tie.ratio * start(other, all, ties - 1))
    };
    entry.start.or_else(tied).unwrap_or(f64::NAN)
}

/// Converts the stated finite-difference step of an unknown to the (scaled) coordinate in which it is
/// searched.
fn difference_step(entry: &UnknownEntry, difference: f64) -> f64 {
    match entry.scale {
        Scale::Logarithmic => libm::log10(1.0 + difference),
        Scale::Linear => {
            let bounds = entry.lower.zip(entry.upper);
            bounds.map_or(f64::NAN, |(lower, upper)| {
                2.0 * difference / (upper - lower)
            })
        }
    }
}
