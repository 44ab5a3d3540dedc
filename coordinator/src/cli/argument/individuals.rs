//! Table of individuals: a CSV file with a column for each unknown that a case searches.
use case::{CaseError, file, table::CsvTable};
use exchange::{decoded, table::TextTable};
use search::space::{Axis, Space};
use std::path::Path;
use store::gene_column;

/// Names of columns that identify a table written by this program: by `export`, or by a sweep. Such a table
/// may have further columns, which hold results.
const EXPORTED: [&[&str]; 2] = [&["job", "verdict"], &["objective", "verdict"]];

/// Individuals read from a user's CSV table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Individuals {
    /// Names of the searched unknowns, in the case's order.
    pub(crate) names: Vec<String>,
    /// Values of the searched unknowns, one row per individual \[declared units\].
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Individuals {
    /// Reads the individuals of a CSV table; all rows are checked before any is used.
    ///
    /// # Errors
    /// If an unknown is missing or not in the case, a row has another length, a cell is not a finite number
    /// or lies outside the bounds, or there are no rows.
    pub(crate) fn read(path: &Path, space: &Space) -> Result<Self, CaseError> {
        let bytes = file::read(path, "the table of individuals that was asked for")?;
        let names = space.axes().iter().map(|axis| axis.unknown.name.as_str());
        let names: Vec<&str> = names.collect();
        let header = TextTable::parse(&decoded(&bytes), &[]).names;
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
            CsvTable::read(path, &bytes, &wanted)?
        } else {
            CsvTable::read_alone(path, &bytes, &wanted)?
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
                let help = "choose a value inside the bounds, or widen the bounds of this unknown in case.toml";
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
