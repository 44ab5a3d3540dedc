//! `[[effects]]` tables of a case file: effects with their parameters, units, intervals and provenance.
//!
//! The effects are defined by the model and are not known here: shape, units and numbers are checked when the
//! case is read, identifiers when workers announce the effects that they support.
use super::{
    conversion::{convert, factor},
    document::{Document, DocumentStep, nearest, short},
    error::{CaseError, Faults},
    prior::interval,
};
use protocol::announce::EffectDescriptor;
use protocol::case::{Case, EffectSetting, Scale, Unknown};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `[[effects]]` table of a case file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseEffect {
    /// Identifier of the effect, as `pivot_friction`.
    pub id: String,
    /// Parameters of the effect by name; parameters not listed keep the model's default.
    #[serde(default)]
    pub parameters: BTreeMap<String, CaseParameter>,
    /// Diagnosis that found the effect; absent for an effect written by hand.
    pub provenance: Option<Provenance>,
}

/// Parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseParameter {
    /// Value of the parameter, in `unit`.
    pub value: f64,
    /// Unit of all numbers in this table; must equal the unit that the effect declares.
    pub unit: String,
    /// 95 % confidence interval of the value, if it was estimated.
    pub ci95: Option<[f64; 2]>,
    /// Search interval for calibration; a parameter without it is not searched.
    pub search: Option<[f64; 2]>,
}

/// Provenance of an effect: the diagnosis that named it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Content hash of the case, including the records in which the effect was found.
    pub dataset: Option<String>,
    /// Name of the run that found the effect.
    pub run: Option<String>,
    /// Verdict of the run that found the effect, such as `named`.
    pub verdict: Option<String>,
    /// Ambiguity set: identifiers of the effects that the records cannot distinguish, including this effect's
    /// own.
    #[serde(default)]
    pub set: Vec<String>,
    /// Gain of log evidence over the model without the effect \[1\].
    pub ln_evidence_gain: Option<f64>,
    /// Round of the diagnosis in which the effect was found, from 1.
    pub round: Option<u32>,
}

impl CaseEffect {
    /// Returns the effects of a case, without intervals of confidence and provenance, which a case does not hold.
    pub fn all_of(case: &Case) -> Vec<Self> {
        let effects = case.effects.iter().zip(&case.effect_units);
        let one = |(setting, units): (&EffectSetting, &Vec<String>)| {
            let parameters = setting.parameters.iter().zip(units);
            let parameters = parameters.map(|((name, value), unit)| {
                let own = |unknown: &&Unknown| unknown.of_effect() == Some((&setting.id, name));
                let searched = case.unknowns.iter().find(own);
                let parameter = CaseParameter {
                    value: *value,
                    unit: unit.clone(),
                    ci95: None,
                    search: searched.map(|unknown| [unknown.lower, unknown.upper]),
                };
                (name.clone(), parameter)
            });
            Self {
                id: setting.id.clone(),
                parameters: parameters.collect(),
                provenance: None,
            }
        };
        effects.map(one).collect()
    }

    /// Returns the effect in the form that is sent to workers.
    pub fn setting(&self) -> EffectSetting {
        let parameters = self.parameters.iter();
        EffectSetting {
            id: self.id.clone(),
            parameters: parameters
                .map(|(name, p)| (name.clone(), p.value))
                .collect(),
        }
    }

    /// Returns the units of the effect's parameters, in the order in which [`Self::setting`] lists the
    /// parameters.
    pub fn units(&self) -> Vec<String> {
        self.parameters.values().map(|p| p.unit.clone()).collect()
    }

    /// Returns the searched parameters of the effect as unknowns, in the order in which [`Self::setting`]
    /// lists the parameters.
    pub fn genes(&self) -> impl Iterator<Item = Unknown> {
        self.parameters.iter().filter_map(|(name, p)| {
            let label = format!("{}.{name}", self.id);
            let unknown = Unknown::new(label, &p.unit, Scale::Linear, p.value, p.search?);
            // what it was found with is known of it
            let found = p.ci95.filter(|[low, high]| low < high);
            Some(Unknown {
                title: format!("{name} of {}", self.id.replace('_', " ")),
                prior: found.map(|ci95| interval(&unknown, ci95)),
                is_effect: true,
                ..unknown
            })
        })
    }
}

/// Checks shape, units and numbers of effects. `units` lists the units allowed for this kind of model; if it
/// is empty, any unit is accepted here and a worker refuses those that it does not know.
///
/// # Errors
/// Returns all invalid identifiers, units and numbers.
pub fn check(document: &Document, effects: &[CaseEffect], units: &[&str]) -> Result<(), CaseError> {
    let mut faults = Faults::default();
    for (index, effect) in effects.iter().enumerate() {
        let keys = |key| {
            [
                DocumentStep::Key("effects"),
                DocumentStep::Index(index),
                DocumentStep::Key(key),
            ]
        };
        let quoted = format!("\"{}\"", effect.id);
        if !is_name(&effect.id) {
            faults.add(document.field(
                &keys("id"),
                quoted,
                "an identifier of small letters, digits, `_` and `.`",
                "write the identifier of an effect, as `pivot_friction`",
            ));
        } else if effects[..index].iter().any(|other| other.id == effect.id) {
            faults.add(document.field(
                &keys("id"),
                quoted,
                "an effect that no other table has",
                "duplicate effect: put all its parameters into one table",
            ));
        }
        for (name, parameter) in &effect.parameters {
            faults.take(check_unit(document, (index, name), parameter, units));
            faults.take(check_parameter(document, index, name, parameter));
        }
    }
    faults.end()
}

/// Checks effects against those that workers support.
///
/// # Errors
/// Returns every effect and parameter that is not known, has another unit or lies outside its range.
pub fn check_known(
    document: &Document,
    effects: &[CaseEffect],
    known: &[EffectDescriptor],
) -> Result<(), CaseError> {
    let mut faults = Faults::default();
    for (index, effect) in effects.iter().enumerate() {
        let table = [DocumentStep::Key("effects"), DocumentStep::Index(index)];
        let Some(own) = known.iter().find(|own| own.id == effect.id) else {
            let ids = known.iter().filter(|own| !own.generic);
            let ids: Vec<&str> = ids.map(|own| own.id.as_str()).collect();
            faults.add(document.field(
                &[table[0], table[1], DocumentStep::Key("id")],
                format!("\"{}\"", effect.id),
                format!("an effect that the workers know: {}", ids.join(", ")),
                &suggestion(&effect.id, &ids),
            ));
            continue;
        };
        let names: Vec<&str> = own.parameters.iter().map(|p| p.name.as_str()).collect();
        for (name, parameter) in &effect.parameters {
            let keys = [
                table[0],
                table[1],
                DocumentStep::Key("parameters"),
                DocumentStep::Key(name),
            ];
            let Some(known) = own.parameters.iter().find(|known| known.name == *name) else {
                faults.add(document.field(
                    &keys,
                    parameter.value,
                    format!("a parameter of {}: {}", own.id, names.join(", ")),
                    &suggestion(name, &names),
                ));
                continue;
            };
            let to = |key| [keys[0], keys[1], keys[2], keys[3], DocumentStep::Key(key)];
            if parameter.unit != known.unit {
                faults.add(document.field(
                    &to("unit"),
                    format!("\"{}\"", parameter.unit),
                    format!("\"{}\"", known.unit),
                    &convert(&parameter.unit, &known.unit),
                ));
            } else if !(known.lower..=known.upper).contains(&parameter.value) {
                faults.add(document.field(
                    &to("value"),
                    parameter.value,
                    format!(
                        "{} to {} {}",
                        short(known.lower),
                        short(known.upper),
                        known.unit
                    ),
                    "correct the value, or its unit",
                ));
            }
        }
    }
    faults.end()
}

/// Returns the remedy text for a misspelt word, which suggests the most similar candidate, if there is one.
fn suggestion(word: &str, candidates: &[&str]) -> String {
    let near = nearest(word, candidates.iter().copied());
    near.map_or("name one of them".to_owned(), |near| {
        format!("did you mean `{near}`?")
    })
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
    let near = units.iter().find(|known| factor(unit, known).is_some());
    let near = near
        .copied()
        .or_else(|| nearest(unit, units.iter().copied()));
    Err(document.field(
        &[
            DocumentStep::Key("effects"),
            DocumentStep::Index(index),
            DocumentStep::Key("parameters"),
            DocumentStep::Key(name),
            DocumentStep::Key("unit"),
        ],
        format!("\"{unit}\""),
        format!("one of {}", units.join(", ")),
        &near.map_or(
            "state the value in the unit of the effect".to_owned(),
            |near| convert(unit, near),
        ),
    ))
}

fn check_parameter(
    document: &Document,
    index: usize,
    name: &str,
    parameter: &CaseParameter,
) -> Result<(), CaseError> {
    let keys = |key| {
        [
            DocumentStep::Key("effects"),
            DocumentStep::Index(index),
            DocumentStep::Key("parameters"),
            DocumentStep::Key(name),
            DocumentStep::Key(key),
        ]
    };
    let unit = parameter.unit.as_str();
    if !parameter.value.is_finite() {
        return Err(document.field(
            &keys("value"),
            parameter.value,
            format!("a finite number of {unit}"),
            "correct the value; the workers check its bounds",
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
            &keys(key),
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
