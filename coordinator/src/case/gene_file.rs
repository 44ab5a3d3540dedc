//! Files that give each gene of a case a value, as `calibrated.toml` of a run.
//!
//! A line per gene: `kb1 = { value = 7.81e8, unit = "N/m" }`, and for a parameter of one of the case's
//! effects its label as the key, `"pin_clearance.force" = { value = 1500.0, unit = "N" }`.
use super::{
    document::{Document, Step, nearest},
    error::CaseError,
    genes::{check_unit, check_value},
};
use protocol::{
    case::{Case, Coefficient, Quantity},
    unit::Unit,
};
use serde::{
    Deserialize,
    de::{self, MapAccess, Visitor},
};
use std::{collections::BTreeMap, fmt, path::Path};

/// One gene of a gene file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GeneValue<U> {
    value: f64,
    unit: U,
}

/// A gene file: a value for every coefficient, and for parameters of effects by their labels.
struct GeneFile {
    coefficients: BTreeMap<Coefficient, GeneValue<Unit>>,
    effects: BTreeMap<String, GeneValue<String>>,
}

/// What stands before an equals sign.
enum Key {
    Coefficient(Coefficient),
    Effect(String),
}

const COEFFICIENTS: &[&str] = &{
    let mut names = [""; 10];
    let mut at = 0;
    while at < names.len() {
        names[at] = Coefficient::ALL[at].as_str();
        at += 1;
    }
    names
};

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: de::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let key = String::deserialize(from)?;
        let named = Coefficient::ALL.into_iter().find(|c| c.as_str() == key);
        match named {
            Some(coefficient) => Ok(Self::Coefficient(coefficient)),
            // every label of an effect's parameter has one
            None if key.contains('.') => Ok(Self::Effect(key)),
            None => Err(de::Error::unknown_field(&key, COEFFICIENTS)),
        }
    }
}

impl<'de> Deserialize<'de> for GeneFile {
    fn deserialize<D: de::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(Genes)
    }
}

struct Genes;

impl<'de> Visitor<'de> for Genes {
    type Value = GeneFile;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("genes by name")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<GeneFile, A::Error> {
        let mut file = GeneFile {
            coefficients: BTreeMap::new(),
            effects: BTreeMap::new(),
        };
        while let Some(key) = map.next_key()? {
            match key {
                Key::Coefficient(name) => {
                    file.coefficients.insert(name, map.next_value()?);
                }
                Key::Effect(label) => {
                    file.effects.insert(label, map.next_value()?);
                }
            }
        }
        for name in Coefficient::ALL {
            if !file.coefficients.contains_key(&name) {
                return Err(de::Error::missing_field(name.as_str()));
            }
        }
        Ok(file)
    }
}

/// Reads a gene file; values are returned in the case's units and order. They may lie outside the
/// bounds, which are those of the search. Every coefficient must have one; a parameter of an effect
/// that the file does not name keeps the case's value, so files from before it was known still hold.
///
/// # Errors
/// A missing or unknown gene, a unit that does not fit, a value that cannot be one.
pub fn read_genes(path: &Path, case: &Case) -> Result<Vec<f64>, CaseError> {
    let document = Document::read(path, "the gene file that was asked for")?;
    let file: GeneFile = document.parse()?;
    for (name, entry) in &file.coefficients {
        let way = |key| [Step::Key(name.as_str()), Step::Key(key)];
        check_unit(&document, &way("unit"), *name, entry.unit)?;
        check_value(&document, &way("value"), entry.value, entry.unit)?;
    }
    for (label, entry) in &file.effects {
        check_effect(&document, case, (label, entry))?;
    }
    let values = case.genes.iter().map(|gene| match &gene.quantity {
        Quantity::Coefficient { name, unit } => {
            file.coefficients
                .get(name)
                .map_or(gene.recommended, |entry| {
                    // the same unit needs no conversion, which would cost the last digit
                    if entry.unit == *unit {
                        entry.value
                    } else {
                        entry.unit.to_si(entry.value) / unit.si_factor()
                    }
                })
        }
        Quantity::Effect { .. } => file
            .effects
            .get(&gene.label())
            .map_or(gene.recommended, |entry| entry.value),
    });
    Ok(values.collect())
}

/// A parameter of an effect is a gene of the case, in the case's unit, with a number.
fn check_effect(
    document: &Document,
    case: &Case,
    (label, entry): (&str, &GeneValue<String>),
) -> Result<(), CaseError> {
    let way = |key| [Step::Key(label), Step::Key(key)];
    let of_effects = || {
        case.genes
            .iter()
            .filter(|gene| gene.quantity.is_of_effect())
    };
    let Some(gene) = of_effects().find(|gene| gene.label() == label) else {
        let known: Vec<String> = of_effects().map(protocol::case::Gene::label).collect();
        let help = match nearest(label, known.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "remove the line, or state `search = [low, high]` for that parameter in the \
                     case's [[effects]]"
                .to_owned(),
        };
        let allowed = match known.as_slice() {
            [] => "no parameter of an effect: the case searches none".to_owned(),
            all => format!("a parameter that the case searches: {}", all.join(", ")),
        };
        return Err(document.field(&[Step::Key(label)], entry.value, allowed, &help));
    };
    if entry.unit != gene.unit() {
        return Err(document.field(
            &way("unit"),
            format!("\"{}\"", entry.unit),
            format!("\"{}\", as in the case", gene.unit()),
            "state the value in the unit of the effect",
        ));
    }
    if !entry.value.is_finite() {
        return Err(document.field(
            &way("value"),
            entry.value,
            format!("a finite number of {}", gene.unit()),
            "correct the value; a worker knows its bounds",
        ));
    }
    Ok(())
}

/// A gene file of these values, which [`read_genes`] gives back to the bit.
pub fn write_genes(case: &Case, values: &[f64], about: &str) -> String {
    let mut text = format!("# {about}\n");
    for (gene, value) in case.genes.iter().zip(values) {
        let name = toml_edit::Key::new(gene.label())
            .display_repr()
            .into_owned();
        let unit = gene.unit();
        let line = format!("{name:<4} = {{ value = {value:e}, unit = \"{unit}\" }}\n");
        text.push_str(&line);
    }
    text
}
