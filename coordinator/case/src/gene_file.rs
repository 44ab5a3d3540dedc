//! Gene files, which state values for the unknowns of a case, as `calibrated.toml` of a run.
//!
//! Each unknown has a line `stiffness = { value = 6.2, unit = "N/mm" }`; a name with a dot, such as a
//! parameter of an effect, is quoted: `"pin_clearance.force" = { value = 1500.0, unit = "N" }`.
use super::{
    conversion::convert,
    document::{Document, DocumentStep, nearest},
    error::CaseError,
};
use protocol::{
    case::{Case, Scale, Unknown},
    unit::Unit,
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::Path};

/// Entry of a gene file: the value of one unknown, with its unit.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a value with its unit; write `{ value = 3.14e8, unit = \"N/m\" }`"
)]
struct GeneValue {
    value: f64,
    unit: String,
}

/// Reads a gene file; returns the values in the case's units and order. Values may lie outside the bounds,
/// which only limit the search. Every unknown needs an entry, except parameters of effects: without an entry
/// these keep the case's value, so that files written before an effect was added stay usable.
///
/// # Errors
/// Returns an error for a missing or unknown name, an incompatible unit or an invalid value.
pub fn read_genes(path: &Path, case: &Case) -> Result<Vec<f64>, CaseError> {
    let document = Document::read(path, "the gene file named on the command line")?;
    let file: BTreeMap<String, GeneValue> = document.parse()?;
    for (name, entry) in &file {
        if !case.unknowns.iter().any(|unknown| unknown.name == *name) {
            return Err(unknown_name_error(&document, case, (name, entry)));
        }
    }
    let values = case.unknowns.iter().map(|unknown| {
        if let Some(entry) = file.get(&unknown.name) {
            return value(&document, unknown, entry);
        }
        if unknown.of_effect().is_some() {
            return Ok(unknown.start);
        }
        let Unknown {
            name, start, unit, ..
        } = unknown;
        Err(document.field(
            &[DocumentStep::Key(name)],
            "missing",
            format!("a value of {name}, as of every unknown of the case"),
            &format!("add `{name} = {{ value = {start:e}, unit = \"{unit}\" }}`"),
        ))
    });
    values.collect()
}

/// Converts the value of a gene-file entry to the unit in which the case states the unknown.
fn value(document: &Document, unknown: &Unknown, entry: &GeneValue) -> Result<f64, CaseError> {
    let way = |key| {
        [
            DocumentStep::Key(unknown.name.as_str()),
            DocumentStep::Key(key),
        ]
    };
    let GeneValue { value, unit } = entry;
    let units = Unit::named(&unknown.unit).zip(Unit::named(unit));
    let fitting = units.filter(|(own, stated)| own.si() == stated.si());
    // the same unit needs no conversion, which would cost the last digit
    let value = match fitting {
        Some((own, stated)) if own != stated => &(stated.to_si(*value) / own.si_factor()),
        _ => value,
    };
    if *unit != unknown.unit && fitting.is_none() {
        return Err(document.field(
            &way("unit"),
            format!("\"{unit}\""),
            format!("\"{}\", as in the case", unknown.unit),
            &convert(unit, &unknown.unit),
        ));
    }
    let (sound, allowed) = match unknown.scale {
        Scale::Logarithmic => (value.is_finite() && *value > 0.0, "positive"),
        Scale::Linear => (value.is_finite(), "finite"),
    };
    if !sound {
        return Err(document.field(
            &way("value"),
            value,
            format!("a {allowed} number of {unit}"),
            "correct the value; the workers check its bounds",
        ));
    }
    Ok(*value)
}

/// Builds the error for a gene-file entry whose name is not that of an unknown of the case.
fn unknown_name_error(
    document: &Document,
    case: &Case,
    (name, entry): (&str, &GeneValue),
) -> CaseError {
    let known: Vec<&str> = case.unknowns.iter().map(|u| u.name.as_str()).collect();
    let help = match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            "remove the line; for a parameter of an effect, state `search = [low, high]` for it in \
                 the case's [[effects]]"
                .to_owned()
        }
    };
    let allowed = format!("an unknown of the case: {}", known.join(", "));
    document.field(&[DocumentStep::Key(name)], entry.value, allowed, &help)
}

/// Returns the text of a gene file with the given values of the unknowns; [`read_genes`] reads back
/// bit-identical values.
pub fn write_genes(case: &Case, values: &[f64], about: &str) -> String {
    let mut text = format!("# {about}\n");
    for (unknown, value) in case.unknowns.iter().zip(values) {
        let name = toml_edit::Key::new(&unknown.name)
            .display_repr()
            .into_owned();
        let unit = toml_edit::Value::from(unknown.unit.as_str());
        let unit = unit.to_string();
        let line = format!(
            "{name:<4} = {{ value = {value:e}, unit = {} }}\n",
            unit.trim()
        );
        text.push_str(&line);
    }
    text
}
