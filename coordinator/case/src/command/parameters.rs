//! Export of a case's unknowns as a PEST parameter file.
use exchange::pest::{self, ParRow};
use protocol::{
    case::{Case, Unknown},
    external::External,
};

/// Returns the text of a PEST parameter file with the given values of the unknowns.
pub(super) fn parameters(case: &Case, genes: &[f64]) -> String {
    let external = External::of(&case.model).ok();
    let written = external.map(|own| own.parameters).unwrap_or_default();
    let row = |(at, (unknown, value)): (usize, (&Unknown, &f64))| ParRow {
        name: unknown.name.clone(),
        value: *value,
        scale: written.get(at).map_or(1.0, |own| own.factor),
        offset: written.get(at).map_or(0.0, |own| own.offset),
    };
    let rows: Vec<ParRow> = case
        .unknowns
        .iter()
        .zip(genes)
        .enumerate()
        .map(row)
        .collect();
    pest::par(&rows)
}
