//! Conversion of the rope and contact coefficients that a case declares to unknowns of a search.
use super::{coefficient::Bodies, recommended::Recommended, schema::GeneEntry};
use crate::{
    document::{Document, DocumentStep, units},
    error::{CaseError, Faults},
};
use protocol::{
    case::{HeldRatios, Scale, Shift, Unknown, Valley},
    pumping_unit::Coefficient,
    unit::Unit,
};
use std::collections::BTreeMap;

/// Upper limit of the value of a rope or contact coefficient, in SI units.
const LARGEST: f64 = 1.0e30;

/// Returns the checked coefficients of a case as unknowns.
///
/// # Errors
/// Returns an error for a unit of another dimension, a value that is not positive, bounds that exclude the
/// recommended value, or a formula that does not cover the coefficient.
pub(super) fn declared(
    document: &Document,
    table: &BTreeMap<Coefficient, GeneEntry>,
    bodies: &Bodies,
) -> Result<Vec<Unknown>, CaseError> {
    let mut faults = Faults::default();
    let all = Coefficient::ALL.into_iter();
    let genes = all.filter_map(|name| faults.take(gene(document, table, bodies, name)));
    let genes = genes.collect();
    faults.end()?;
    Ok(genes)
}

/// Returns one checked coefficient of a case as an unknown.
fn gene(
    document: &Document,
    table: &BTreeMap<Coefficient, GeneEntry>,
    bodies: &Bodies,
    name: Coefficient,
) -> Result<Unknown, CaseError> {
    let Some(entry) = table.get(&name) else {
        return Err(document.field(
            &[DocumentStep::Key("genes")],
            format!("a table without `{}`", name.as_str()),
            "all ten coefficients: kb1, kb23, kb4, kb56, cb1, cb23, cb4, cb56, kc, cc",
            &format!(
                "add `{} = {{ recommended = .., lower = .., upper = .., unit = \"..\" }}`",
                name.as_str()
            ),
        ));
    };
    let keys = |key| {
        [
            DocumentStep::Key("genes"),
            DocumentStep::Key(name.as_str()),
            DocumentStep::Key(key),
        ]
    };
    check_unit(document, &keys("unit"), name, entry.unit)?;
    let recommended = match entry.recommended {
        Recommended::Value(value) => value,
        Recommended::Formula(formula) => match bodies.evaluate(formula, name) {
            Some(si) => si / entry.unit.si_factor(),
            None => {
                return Err(document.field(
                    &keys("recommended"),
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
        check_value(document, &keys(key), value, entry.unit)?;
    }
    if entry.lower >= entry.upper {
        return Err(document.field(
            &keys("lower"),
            entry.lower,
            format!("below upper = {} {}", entry.upper, entry.unit.symbol()),
            "exchange or widen the bounds",
        ));
    }
    if !(entry.lower..=entry.upper).contains(&recommended) {
        return Err(document.field(
            &keys("recommended"),
            recommended,
            format!("{} to {} {}", entry.lower, entry.upper, entry.unit.symbol()),
            "the bounds exclude the recommended value: widen them, or correct it",
        ));
    }
    let bounds = [entry.lower, entry.upper];
    let mut gene = unknown(name, entry.unit, recommended, bounds);
    if let Some(prior) = entry.prior {
        gene.prior = Some(prior.of(&gene, document, &keys("prior"))?);
    }
    Ok(gene)
}

/// Returns a coefficient as an unknown of a search.
pub fn unknown(name: Coefficient, unit: Unit, start: f64, bounds: [f64; 2]) -> Unknown {
    let (letter, index) = name.as_str().split_at(1);
    Unknown {
        title: name.title().to_owned(),
        symbol: format!("{}_{index}", letter.to_uppercase()),
        trust: Some(trust(unit)),
        valley: (name == Coefficient::Kb1).then(valley),
        ..Unknown::new(
            name.as_str(),
            unit.symbol(),
            Scale::Logarithmic,
            start,
            bounds,
        )
    }
}

/// Returns the range of a coefficient, in decades about its start value, in which simulations usually
/// succeed. The stiffness of a rope is known to about a decade, its damping to several, because the damping
/// of a joint represents all losses of the machine. Contact coefficients are conventions of a simulation
/// program rather than properties of the machine, and recommended values are mostly too soft.
const fn trust(unit: Unit) -> [f64; 2] {
    match unit {
        Unit::NewtonPerMetre | Unit::NewtonMetrePerRadian | Unit::NewtonMetrePerDegree => {
            [-1.0, 1.5]
        }
        Unit::NewtonSecondPerMetre
        | Unit::NewtonMetreSecondPerRadian
        | Unit::NewtonMetreSecondPerDegree => [-1.0, 4.0],
        Unit::NewtonPerMetreToThreeHalves => [-0.5, 3.5],
    }
}

/// Returns the grid scan that finds the narrow minimum of the objective along the axial rope stiffness. The
/// load excites two modes of the rope, at about sixty and eighty cycles per turn, and a stiffness a few
/// hundredths of a decade off shifts their phase. High damping suppresses the modes; a soft contact can
/// compensate a soft rope; with a very hard contact no small change is visible; the scan therefore also
/// shifts these coefficients. The damping-to-stiffness ratios correspond to 1 and 4 % of critical damping at
/// the modes' 6 Hz, the range of wire ropes.
fn valley() -> Valley {
    let shift = |name: Coefficient, by| Shift {
        unknown: name.as_str().to_owned(),
        by,
    };
    Valley {
        from: -0.3,
        to: 1.1,
        step: 0.02,
        uncovered_by: vec![shift(Coefficient::Cb1, -0.8), shift(Coefficient::Kc, 1.5)],
        shares: Some(HeldRatios {
            unknown: Coefficient::Cb1.as_str().to_owned(),
            of_scanned: vec![6e-4, 2e-3],
        }),
        stand_ins: vec![shift(Coefficient::Kc, 1.5), shift(Coefficient::Kc, -1.5)],
    }
}

/// Checks that the unit stated for a rope or contact coefficient has the right dimension.
pub(super) fn check_unit(
    document: &Document,
    keys: &[DocumentStep<'_>],
    name: Coefficient,
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
        keys,
        format!("\"{}\"", unit.symbol()),
        format!("{} for {}", fitting.join(" or "), name.as_str()),
        &format!("state the value in a unit that fits; there are {}", units()),
    ))
}

/// Checks that a rope or contact coefficient is positive and finite, as its logarithmic scale requires.
pub(super) fn check_value(
    document: &Document,
    keys: &[DocumentStep<'_>],
    value: f64,
    unit: Unit,
) -> Result<(), CaseError> {
    if value > 0.0 && unit.to_si(value) <= LARGEST {
        return Ok(());
    }
    Err(document.field(
        keys,
        value,
        format!("above 0, at most {LARGEST:e} in SI [{}]", unit.symbol()),
        "stiffness and damping are positive and searched on a logarithmic scale",
    ))
}
