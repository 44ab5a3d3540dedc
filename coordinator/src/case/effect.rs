//! Effects of a case file: numbers with their units and intervals, and where they come from.
//!
//! What effects there are is the model's business and not known here: shape, units and numbers are
//! checked, names are not. A worker refuses what its model does not have, naming the same field.
use super::{
    document::{Document, Step, nearest},
    error::CaseError,
    prior::interval,
};
use protocol::case::{EffectSetting, Scale, Unknown};
use serde::Deserialize;
use std::collections::BTreeMap;

/// One `[[effects]]` table.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseEffect {
    /// Fixed identifier, as `pivot_friction`.
    pub id: String,
    /// Its numbers by name; what is not named stays as the model has it.
    #[serde(default)]
    pub parameters: BTreeMap<String, CaseParameter>,
    /// Where it comes from; absent where somebody wrote it by hand.
    pub provenance: Option<Provenance>,
}

/// One number of an effect.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseParameter {
    /// Value, in `unit`.
    pub value: f64,
    /// Unit of all numbers here; it must be the one that the effect declares.
    pub unit: String,
    /// Interval that holds the value with 95 % confidence, if it was estimated.
    pub ci95: Option<[f64; 2]>,
    /// Interval that a calibration searches; without one the parameter is no gene.
    pub search: Option<[f64; 2]>,
}

/// Where an effect comes from: the diagnosis that named it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Content hash of the case, with the records that it was found in.
    pub dataset: Option<String>,
    /// Name of the run that found it.
    pub run: Option<String>,
    /// What that run concluded, as `named`.
    pub verdict: Option<String>,
    /// Identifiers that the records cannot tell from it, itself among them.
    #[serde(default)]
    pub set: Vec<String>,
    /// Gain of log evidence over the model without it \[1\].
    pub ln_evidence_gain: Option<f64>,
    /// Round of the diagnosis, from 1.
    pub round: Option<u32>,
}

impl CaseEffect {
    /// As it travels.
    pub fn setting(&self) -> EffectSetting {
        let parameters = self.parameters.iter();
        EffectSetting {
            id: self.id.clone(),
            parameters: parameters
                .map(|(name, p)| (name.clone(), p.value))
                .collect(),
        }
    }

    /// Units of its parameters, in the order of [`Self::setting`].
    pub fn units(&self) -> Vec<String> {
        self.parameters.values().map(|p| p.unit.clone()).collect()
    }

    /// Its parameters that are searched, in the order of [`Self::setting`].
    pub fn genes(&self) -> impl Iterator<Item = Unknown> {
        self.parameters.iter().filter_map(|(name, p)| {
            let label = format!("{}.{name}", self.id);
            let unknown = Unknown::new(label, &p.unit, Scale::Linear, p.value, p.search?);
            // what it was found with is known of it
            let found = p.ci95.filter(|[low, high]| low < high);
            Some(Unknown {
                title: format!("{name} of {}", self.id.replace('_', " ")),
                prior: found.map(|ci95| interval(&unknown, ci95)),
                ..unknown
            })
        })
    }
}

/// Checks shape, units and numbers; `units` are those that effects of this kind of model may have, none
/// where nobody here knows them: then a unit is a word, and a worker refuses what is not its own.
///
/// # Errors
/// The first identifier, unit or number that cannot be right.
pub(crate) fn check(
    document: &Document,
    effects: &[CaseEffect],
    units: &[&str],
) -> Result<(), CaseError> {
    for (index, effect) in effects.iter().enumerate() {
        let way = |key| [Step::Key("effects"), Step::Index(index), Step::Key(key)];
        let quoted = format!("\"{}\"", effect.id);
        if !is_name(&effect.id) {
            return Err(document.field(
                &way("id"),
                quoted,
                "an identifier of small letters, digits, `_` and `.`",
                "write the identifier of an effect, as `pivot_friction`",
            ));
        }
        if effects[..index].iter().any(|other| other.id == effect.id) {
            return Err(document.field(
                &way("id"),
                quoted,
                "an effect that no other table has",
                "duplicate effect: put all its parameters into one table",
            ));
        }
        for (name, parameter) in &effect.parameters {
            check_unit(document, (index, name), parameter, units)?;
            check_parameter(document, index, name, parameter)?;
        }
    }
    Ok(())
}

fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '_' | '.');
    !text.is_empty() && text.chars().all(plain)
}

fn check_unit(
    document: &Document,
    (index, name): (usize, &str),
    parameter: &CaseParameter,
    units: &[&str],
) -> Result<(), CaseError> {
    let unit = parameter.unit.as_str();
    if units.is_empty() || units.contains(&unit) {
        return Ok(());
    }
    let near = nearest(unit, units.iter().copied());
    Err(document.field(
        &[
            Step::Key("effects"),
            Step::Index(index),
            Step::Key("parameters"),
            Step::Key(name),
            Step::Key("unit"),
        ],
        format!("\"{unit}\""),
        format!("one of {}", units.join(", ")),
        &near.map_or(
            "state the value in the unit of the effect".to_owned(),
            |near| format!("did you mean `{near}`?"),
        ),
    ))
}

fn check_parameter(
    document: &Document,
    index: usize,
    name: &str,
    parameter: &CaseParameter,
) -> Result<(), CaseError> {
    let way = |key| {
        [
            Step::Key("effects"),
            Step::Index(index),
            Step::Key("parameters"),
            Step::Key(name),
            Step::Key(key),
        ]
    };
    let unit = parameter.unit.as_str();
    if !parameter.value.is_finite() {
        return Err(document.field(
            &way("value"),
            parameter.value,
            format!("a finite number of {unit}"),
            "correct the value; a worker knows its bounds",
        ));
    }
    for (key, interval, is_search) in [
        ("ci95", parameter.ci95, false),
        ("search", parameter.search, true),
    ] {
        let Some([low, high]) = interval else {
            continue;
        };
        let around = (low..=high).contains(&parameter.value) && (high - low).is_finite();
        if around && (low < high || !is_search) {
            continue;
        }
        let apart = if is_search { "different " } else { "" };
        return Err(document.field(
            &way(key),
            format!("[{low}, {high}]"),
            format!(
                "two {apart}finite numbers around the value, {}",
                parameter.value
            ),
            &format!("write the lower bound first, or leave {key} out"),
        ));
    }
    Ok(())
}
