//! Tables about the run as a whole: what is known of it, its genes, and what every column means.
use crate::{
    column::{Column, Columns},
    row::Fact,
};
use protocol::{case::Unknown, unit::Unit};

pub(super) fn run() -> Columns<Fact> {
    Columns::new()
        .text("name", "what is known of the run", |fact: &Fact| {
            Some(fact.name.clone())
        })
        .text("value", "its value", |fact| Some(fact.value.clone()))
}

/// Name of the column of a gene, with its unit: `stiffness_n_per_m`.
pub fn gene_column(gene: &Unknown) -> String {
    column(&gene.name.replace('.', "_"), &gene.unit)
}

/// Name of a column of values in a unit: `mse_force_n2` in `N2`.
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
            "its SI unit; none where the unit is a word that nothing converts",
            |gene| Some(Unit::named(&gene.unit)?.si().symbol().to_owned()),
        )
        .real(
            "si_factor",
            "what one of the unit is in SI; none where nothing converts it",
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
        .text("meaning", "what it says, with its unit", |(_, column)| {
            Some(column.about.clone())
        })
}
