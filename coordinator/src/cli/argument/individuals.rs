//! A table of individuals: a CSV file with a column for each unknown that a case searches.
use case::{
    CaseError, file,
    table::{Table, columns},
};
use search::space::{Axis, Space};
use std::path::Path;
use store::gene_column;

/// Columns by which a table is one that this program wrote: of `export`, and of a sweep. Its other columns say what came
/// of the individuals.
const EXPORTED: [&[&str]; 2] = [&["job", "verdict"], &["objective", "verdict"]];

/// Individuals that somebody wrote down.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Individuals {
    /// Unknowns that the case searches, in its order.
    pub(crate) names: Vec<String>,
    /// Their values, row by row \[declared units\].
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Individuals {
    /// Reads a table; every row is looked at before anything is done with one.
    ///
    /// # Errors
    /// An unknown that is missing or none of the case, a row of another length, a cell that is no finite number or
    /// lies outside the bounds, no rows.
    pub(crate) fn read(path: &Path, space: &Space) -> Result<Self, CaseError> {
        let bytes = file::read(path, "the table of individuals that was asked for")?;
        let names = space.axes().iter().map(|axis| axis.unknown.name.as_str());
        let names: Vec<&str> = names.collect();
        let header = columns(path, &bytes)?;
        let has = |name: &str| header.iter().any(|column| column == name);
        // tables that were exported name a column by its unit, too
        let named: Vec<String> = space
            .axes()
            .iter()
            .map(|axis| gene_column(&axis.unknown))
            .collect();
        let both = names.iter().copied().zip(&named);
        let wanted = both.map(|(name, exported)| {
            if has(name) || !has(exported) {
                name
            } else {
                exported
            }
        });
        let wanted: Vec<&str> = wanted.collect();
        let exported = EXPORTED.iter().any(|all| all.iter().all(|name| has(name)));
        let table = if exported {
            Table::read(path, &bytes, &wanted)?
        } else {
            Table::read_alone(path, &bytes, &wanted)?
        };
        let row = |row: usize| {
            let cells = table.columns.iter().zip(space.axes()).enumerate();
            let cell = |(column, (values, axis)): (usize, (&Vec<f64>, &Axis))| {
                let (value, unknown) = (values[row], &axis.unknown);
                let (lower, upper) = (unknown.lower, unknown.upper);
                if (lower..=upper).contains(&value) {
                    return Ok(value);
                }
                let allowed = format!("{lower:e} to {upper:e} {}", unknown.unit);
                let help = "choose it inside the bounds, or widen them in case.toml";
                Err(table.cell(path, (row, column), format!("{value:e}"), allowed, help))
            };
            cells.map(cell).collect()
        };
        let rows: Result<Vec<Vec<f64>>, CaseError> = (0..table.lines.len()).map(row).collect();
        Ok(Self {
            rows: rows?,
            names: names.into_iter().map(str::to_owned).collect(),
        })
    }
}
