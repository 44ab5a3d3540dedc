//! Genes: those a case declares, and files that give each a value.
use super::{
    coefficient::{Bodies, Recommended},
    document::{Document, Step, units},
    error::CaseError,
    schema::{GeneEntry, GeneTable, GeneValue},
};
use protocol::{
    case::{Case, Gene, GeneName},
    unit::Unit,
};
use std::path::Path;

/// Largest value of any coefficient, in SI units.
const LARGEST: f64 = 1.0e30;

/// The genes of a case, checked.
///
/// # Errors
/// A unit that does not fit, values that are not positive, bounds that exclude the recommended
/// value, a formula that does not give this coefficient.
pub(super) fn declared(
    document: &Document,
    table: GeneTable<GeneEntry>,
    bodies: &Bodies,
) -> Result<Vec<Gene>, CaseError> {
    let mut genes = Vec::new();
    for (name, entry) in GeneName::ALL.into_iter().zip(table.into_array()) {
        let way = |key| [Step::Key("genes"), Step::Key(name.as_str()), Step::Key(key)];
        check_unit(document, &way("unit"), name, entry.unit)?;
        let recommended = match entry.recommended {
            Recommended::Value(value) => value,
            Recommended::By(formula) => match bodies.give(formula, name) {
                Some(si) => si / entry.unit.si_factor(),
                None => {
                    return Err(document.field(
                        &way("recommended"),
                        format!("\"{}\"", formula.word()),
                        "a number; \"eq3\" for kb1, kb23, kb4 and kb56; \"hertz\" for kc where \
                         contact.exponent = 1.5",
                        "the formula does not give this coefficient: state a value",
                    ));
                }
            },
        };
        let values = [
            ("recommended", recommended),
            ("lower", entry.lower),
            ("upper", entry.upper),
        ];
        for (key, value) in values {
            check_value(document, &way(key), value, entry.unit)?;
        }
        if entry.lower >= entry.upper {
            return Err(document.field(
                &way("lower"),
                entry.lower,
                format!("below upper = {} {}", entry.upper, entry.unit.symbol()),
                "exchange or widen the bounds",
            ));
        }
        if !(entry.lower..=entry.upper).contains(&recommended) {
            return Err(document.field(
                &way("recommended"),
                recommended,
                format!("{} to {} {}", entry.lower, entry.upper, entry.unit.symbol()),
                "the bounds exclude the recommended value: widen them, or correct it",
            ));
        }
        genes.push(Gene {
            name,
            unit: entry.unit,
            recommended,
            lower: entry.lower,
            upper: entry.upper,
        });
    }
    Ok(genes)
}

/// Reads a gene file, `kb1 = { value = 7.81e8, unit = "N/m" }` for every gene of the case; values
/// are returned in the case's units and order. They may lie outside the bounds, which are those
/// of the search.
///
/// # Errors
/// A missing or unknown gene, a unit that does not fit, a value that is not positive.
pub fn read_genes(path: &Path, case: &Case) -> Result<Vec<f64>, CaseError> {
    let document = Document::read(path, "the gene file that was asked for")?;
    let table: GeneTable<GeneValue> = document.parse()?;
    let mut given = Vec::new();
    for (name, entry) in GeneName::ALL.into_iter().zip(table.into_array()) {
        let way = |key| [Step::Key(name.as_str()), Step::Key(key)];
        check_unit(&document, &way("unit"), name, entry.unit)?;
        check_value(&document, &way("value"), entry.value, entry.unit)?;
        given.push((name, entry));
    }
    let wanted = case.genes.iter().filter_map(|gene| {
        let (_, entry) = given.iter().find(|(name, _)| *name == gene.name)?;
        // the same unit needs no conversion, which would cost the last digit
        Some(if entry.unit == gene.unit {
            entry.value
        } else {
            entry.unit.to_si(entry.value) / gene.unit.si_factor()
        })
    });
    Ok(wanted.collect())
}

/// A coefficient's unit measures that kind of coefficient.
fn check_unit(
    document: &Document,
    way: &[Step<'_>],
    name: GeneName,
    unit: Unit,
) -> Result<(), CaseError> {
    if unit.si() == name.si_unit() {
        return Ok(());
    }
    let fitting: Vec<&str> = Unit::ALL
        .into_iter()
        .filter(|unit| unit.si() == name.si_unit())
        .map(Unit::symbol)
        .collect();
    Err(document.field(
        way,
        format!("\"{}\"", unit.symbol()),
        format!("{} for {}", fitting.join(" or "), name.as_str()),
        &format!("state the value in a unit that fits; there are {}", units()),
    ))
}

/// Genes are searched on a logarithmic scale: positive and finite.
fn check_value(
    document: &Document,
    way: &[Step<'_>],
    value: f64,
    unit: Unit,
) -> Result<(), CaseError> {
    if value > 0.0 && unit.to_si(value) <= LARGEST {
        return Ok(());
    }
    Err(document.field(
        way,
        value,
        format!("above 0, at most {LARGEST:e} in SI [{}]", unit.symbol()),
        "stiffness and damping are positive and searched on a logarithmic scale",
    ))
}
