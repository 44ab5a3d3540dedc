//! Tables that describe the run as a whole: its properties, its unknowns, and the dictionary of all columns.
use crate::{
    column::{Column, Columns},
    row::Fact,
};
use protocol::{case::Unknown, unit::Unit};

pub(super) fn run() -> Columns<Fact> {
    Columns::new()
        .text("name", "name of a property of the run", |fact: &Fact| {
            Some(fact.name.clone())
        })
        .text("value", "its value", |fact| Some(fact.value.clone()))
}

/// Returns the column name of an unknown with its unit, for example `stiffness_n_per_m`.
pub fn gene_column(gene: &Unknown) -> String {
    column(&gene.name.replace('.', "_"), &gene.unit)
}

/// Returns a column name with a unit, for example `mse_force_n2` for `mse_force` in `N2`.
pub(super) fn column(name: &str, unit: &str) -> String {
    let unit = unit.to_lowercase();
    let unit = unit.replace('/', "_per_").replace(['.', '^'], "_");
    format!("{name}_{unit}")
}

pub(super) fn genes() -> Columns<Unknown> {
    Columns::new()
        .text("gene", "its name in the case", |gene: &Unknown| {
            Some(gene.name.clone())
        })
        .text("column", "its column in the table evaluations", |gene| {
            Some(gene_column(gene))
        })
        .text("unit", "unit that the case states it in", |gene| {
            Some(gene.unit.clone())
        })
        .real("recommended", "recommended value, in that unit", |gene| {
            Some(gene.start)
        })
        .real("lower", "smallest value to search", |gene| Some(gene.lower))
        .real("upper", "largest value to search", |gene| Some(gene.upper))
        .text(
            "si_unit",
            "its SI unit; none where the unit cannot be converted",
            |gene| Some(Unit::named(&gene.unit)?.si().symbol().to_owned()),
        )
        .real(
            "si_factor",
            "factor that converts the unit to SI; none where the unit cannot be converted",
            |gene| Some(Unit::named(&gene.unit)?.si_factor()),
        )
}

pub(super) fn dictionary() -> Columns<(String, Column)> {
    Columns::new()
        .text("table_name", "table", |(table, _): &(String, Column)| {
            Some(table.clone())
        })
        .text("column_name", "column", |(_, column)| {
            Some(column.name.clone())
        })
        .text("kind", "integer, real or text", |(_, column)| {
            Some(column.kind.as_str().to_owned())
        })
        .text(
            "meaning",
            "meaning of the column, with its unit",
            |(_, column)| Some(column.about.clone()),
        )
}
