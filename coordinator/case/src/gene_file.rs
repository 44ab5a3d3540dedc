//! Gene files, which state values for the unknowns of a case, as `calibrated.toml` of a run.
//!
//! Each unknown has a line `stiffness = { value = 6.2, unit = "N/mm" }`. The effects with which the values were
//! found follow as `[[effects]]` tables, which hold the values of their parameters. Files of version 0.1 have
//! no such tables, and a line `"pin_clearance.force" = { value = 1500.0, unit = "N" }` for each parameter.
use super::{
    conversion::convert,
    document::{Document, DocumentStep, nearest},
    effect::{self, CaseEffect},
    effect_text::write_effects,
    error::CaseError,
};
use protocol::{
    case::{Case, Scale, Unknown},
    unit::Unit,
};
use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, Visitor},
};
use std::{collections::BTreeMap, fmt, path::Path};

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

/// Content of a gene file: values of unknowns by name, and the effects with which they were found.
#[derive(Debug, Default)]
struct Content {
    values: BTreeMap<String, GeneValue>,
    effects: Vec<CaseEffect>,
}

/// Key of the list of effects; every other key is the name of an unknown.
const EFFECTS: &str = "effects";

impl<'de> Deserialize<'de> for Content {
    // `serde(flatten)` would lose the places of errors in the file
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Tables;

        impl<'de> Visitor<'de> for Tables {
            type Value = Content;

            fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
                to.write_str("values of unknowns and a list of effects")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Content, A::Error> {
                let mut content = Content::default();
                while let Some(key) = map.next_key::<String>()? {
                    if key == EFFECTS {
                        content.effects = map.next_value()?;
                    } else {
                        content.values.insert(key, map.next_value()?);
                    }
                }
                Ok(content)
            }
        }

        from.deserialize_map(Tables)
    }
}

/// Gene file that has been read, but not yet compared with a case.
#[derive(Debug)]
pub struct GeneFile {
    document: Document,
    content: Content,
}

impl GeneFile {
    /// Reads a gene file.
    ///
    /// # Errors
    /// Returns an error for a file that is missing or no TOML, or for an invalid effect.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let document = Document::read(path, "the gene file named on the command line")?;
        let content: Content = document.parse()?;
        effect::check(&document, &content.effects, &[])?;
        Ok(Self { document, content })
    }

    /// Returns the effects with which the values were found; none for a file of version 0.1, which did not
    /// state them.
    pub fn effects(&self) -> &[CaseEffect] {
        &self.content.effects
    }

    /// Returns whether the file states values of an effect.
    pub fn states(&self, id: &str) -> bool {
        let mut lines = self.content.values.keys();
        self.content.effects.iter().any(|effect| effect.id == id)
            || lines.any(|name| name.split_once('.').is_some_and(|(effect, _)| effect == id))
    }

    /// Returns the values of a case's unknowns in the case's units and order. Values may lie outside the bounds,
    /// which only limit the search. Every unknown needs an entry, except parameters of effects: without an
    /// entry these keep the case's value, so that files written before an effect was added stay usable.
    ///
    /// # Errors
    /// Returns an error for a missing or unknown name, an incompatible unit or an invalid value, and for an
    /// effect of the file that the case lacks or has at another size; [`Loaded::take_effects`] gives it to
    /// the case.
    ///
    /// [`Loaded::take_effects`]: crate::Loaded::take_effects
    pub fn values(&self, case: &Case) -> Result<Vec<f64>, CaseError> {
        let Self { document, content } = self;
        for (name, entry) in &content.values {
            if !case.unknowns.iter().any(|unknown| unknown.name == *name) {
                return Err(unknown_name_error(document, case, (name, entry)));
            }
        }
        for (index, effect) in content.effects.iter().enumerate() {
            check_effect(document, case, index, effect)?;
        }
        let values = case.unknowns.iter().map(|unknown| {
            if let Some(entry) = content.values.get(&unknown.name) {
                let keys = [DocumentStep::Key(&unknown.name)];
                return value(document, &keys, unknown, entry);
            }
            if let Some((id, name)) = unknown.of_effect() {
                let mut effects = content.effects.iter().enumerate();
                let own = effects.find(|(_, effect)| effect.id == id);
                let own = own.and_then(|(at, effect)| Some((at, effect.parameters.get(name)?)));
                return own.map_or(Ok(unknown.start), |(at, parameter)| {
                    let entry = GeneValue {
                        value: parameter.value,
                        unit: parameter.unit.clone(),
                    };
                    value(document, &of_parameter(at, name), unknown, &entry)
                });
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
}

/// Reads a gene file for a case that has the file's effects; returns the values of the unknowns in the case's
/// order.
///
/// # Errors
/// As [`GeneFile::read`] and [`GeneFile::values`].
pub fn read_genes(path: &Path, case: &Case) -> Result<Vec<f64>, CaseError> {
    GeneFile::read(path)?.values(case)
}

/// Returns the path of a parameter of an effect in a gene file.
fn of_parameter(effect: usize, name: &str) -> [DocumentStep<'_>; 4] {
    [
        DocumentStep::Key(EFFECTS),
        DocumentStep::Index(effect),
        DocumentStep::Key("parameters"),
        DocumentStep::Key(name),
    ]
}

/// Checks that a case has an effect of a gene file, and that parameters that are not searched have the file's
/// values.
fn check_effect(
    document: &Document,
    case: &Case,
    index: usize,
    effect: &CaseEffect,
) -> Result<(), CaseError> {
    let id = effect.id.as_str();
    let Some(own) = case.effects.iter().find(|own| own.id == id) else {
        return Err(document.field(
            &[
                DocumentStep::Key(EFFECTS),
                DocumentStep::Index(index),
                DocumentStep::Key("id"),
            ],
            format!("\"{id}\""),
            "an effect of the case, because the values were found with it",
            "copy the file's [[effects]] table to case.toml, or name a gene file that was found without it",
        ));
    };
    for (name, parameter) in &effect.parameters {
        let searched = |unknown: &Unknown| unknown.of_effect() == Some((id, name));
        if case.unknowns.iter().any(searched) {
            continue;
        }
        let stated = own.parameters.iter().find(|(own, _)| own == name);
        if stated.is_none_or(|(_, value)| value.to_bits() != parameter.value.to_bits()) {
            return Err(document.field(
                &of_parameter(index, name),
                parameter.value,
                match stated {
                    Some((_, value)) => format!("{value} {}, as in the case", parameter.unit),
                    None => "a parameter that the case states".to_owned(),
                },
                "the values were found with it: state it in the case's [[effects]] too",
            ));
        }
    }
    Ok(())
}

/// Converts the value of a gene-file entry to the unit in which the case states the unknown.
fn value(
    document: &Document,
    keys: &[DocumentStep<'_>],
    unknown: &Unknown,
    entry: &GeneValue,
) -> Result<f64, CaseError> {
    let keys = |key| [keys, &[DocumentStep::Key(key)]].concat();
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
            &keys("unit"),
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
            &keys("value"),
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

/// Returns the text of a gene file with the given values of the unknowns and the effects with which they were
/// found; [`read_genes`] reads back bit-identical values. Parameters of effects that are unknowns of the case
/// have the value of the unknown.
pub fn write_genes(case: &Case, values: &[f64], effects: &[CaseEffect], about: &str) -> String {
    let mut text = format!("# {about}\n");
    let mut effects = effects.to_vec();
    for (unknown, value) in case.unknowns.iter().zip(values) {
        let parameter = unknown.of_effect().and_then(|(id, name)| {
            let effect = effects.iter_mut().find(|effect| effect.id == id)?;
            effect.parameters.get_mut(name)
        });
        if let Some(parameter) = parameter {
            if parameter.value.to_bits() != value.to_bits() {
                // the interval belonged to the other value
                parameter.ci95 = None;
                parameter.value = *value;
            }
            continue;
        }
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
    text.push_str(&write_effects(&effects));
    text
}
