//! Columns of numbers from tables in files: named columns, finite numbers, rows counted as lines of the file.
use super::error::{CaseError, damaged};
use exchange::{decoded, table::TextTable};
use std::path::Path;

/// Requested columns of a CSV table, in the order of the request.
#[derive(Debug)]
pub struct CsvTable {
    /// Numbers of each requested column.
    pub columns: Vec<Vec<f64>>,
    /// Line number in the CSV file of each row that was read; the header is line 1.
    pub lines: Vec<u64>,
    /// Names of the requested columns.
    pub names: Vec<String>,
    /// Names of the columns that were not requested.
    pub others: Vec<String>,
}

/// Similarity (normalised Damerau-Levenshtein) to a known column name above which an unknown name counts as
/// its misspelling.
const MEANT: f64 = 0.85;

impl CsvTable {
    /// Reads the requested columns of a CSV table and ignores the others. A `#` before the header is allowed.
    ///
    /// # Errors
    /// A missing or repeated column, a row of another length, a cell that is not a finite number, or no rows.
    pub fn read(path: &Path, bytes: &[u8], wanted: &[&str]) -> Result<Self, CaseError> {
        Self::read_with(path, bytes, wanted, &[])
    }

    /// Reads the requested columns of a CSV table, followed by the optional ones that it has. An unknown
    /// column whose name resembles an optional one counts as its misspelling and is an error, so that no data
    /// are ignored because of a typing error.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(
        path: &Path,
        bytes: &[u8],
        wanted: &[&str],
        optional: &[&str],
    ) -> Result<Self, CaseError> {
        let table = TextTable::parse(&decoded(bytes), wanted);
        let rows: Vec<usize> = (0..table.len()).collect();
        Self::select(path, &table, &rows, (wanted, optional))
    }

    /// Takes the requested columns, and the optional ones that the table has, from some rows of a table.
    ///
    /// # Errors
    /// As [`Self::read_with`].
    pub(crate) fn select(
        path: &Path,
        table: &TextTable,
        rows: &[usize],
        (wanted, optional): (&[&str], &[&str]),
    ) -> Result<Self, CaseError> {
        let header = &table.names;
        // a name that is all but there is a slip, and what it names must not be left out for it
        let unknown = |column: &&String| {
            let known = |name: &&str| *name == column.as_str();
            !wanted.iter().chain(optional).any(known)
        };
        let meant = |column: &String, name: &str| {
            strsim::normalized_damerau_levenshtein(column, name) > MEANT
        };
        let present = |name: &&&str| {
            let mut slips = header.iter().filter(unknown);
            header.iter().any(|column| column == **name) || slips.any(|column| meant(column, name))
        };
        let wanted: Vec<&str> = wanted
            .iter()
            .chain(optional.iter().filter(present))
            .copied()
            .collect();
        let places = wanted
            .iter()
            .map(|name| place(path, header, name, &wanted))
            .collect::<Result<Vec<usize>, CaseError>>()?;
        if rows.is_empty() {
            return Err(damaged(
                path,
                "the table has a header but no rows",
                "copy the file again from its source",
            ));
        }
        let column = |&at: &usize| {
            let numbers = table.numbers(at, rows);
            numbers.map_err(|problem| CaseError::Cell {
                path: path.into(),
                row: problem.line as u64,
                column: problem.column.into(),
                value: problem.found.into(),
                allowed: problem.allowed.into(),
                help: problem.remedy.into(),
            })
        };
        Ok(Self {
            columns: places.iter().map(column).collect::<Result<_, _>>()?,
            lines: rows.iter().map(|row| table.line(*row) as u64).collect(),
            names: wanted.iter().map(|&name| name.to_owned()).collect(),
            others: {
                let other = |name: &&String| !wanted.contains(&name.as_str());
                header.iter().filter(other).cloned().collect()
            },
        })
    }

    /// Reads the requested columns of a table that must have no others.
    ///
    /// # Errors
    /// As [`Self::read`], and for a column that was not requested.
    pub fn read_alone(path: &Path, bytes: &[u8], wanted: &[&str]) -> Result<Self, CaseError> {
        let table = Self::read(path, bytes, wanted)?;
        match table
            .others
            .iter()
            .find(|name| !wanted.contains(&name.as_str()))
        {
            None => Ok(table),
            Some(strange) => Err(damaged(
                path,
                format!("row 1, column `{strange}` is not known"),
                &format!("remove it; the columns are {}", wanted.join(", ")),
            )),
        }
    }

    /// Creates an error about one cell of the CSV table.
    pub fn cell(
        &self,
        path: &Path,
        (row, column): (usize, usize),
        value: impl Into<String>,
        allowed: impl Into<String>,
        help: &str,
    ) -> CaseError {
        CaseError::Cell {
            path: path.into(),
            row: self.lines.get(row).copied().unwrap_or_default(),
            column: self.names.get(column).map_or("", String::as_str).into(),
            value: value.into().into(),
            allowed: allowed.into().into(),
            help: help.into(),
        }
    }
}

/// Returns the index of a CSV column by its name. A column in `needed` is never suggested as the misspelling
/// of another.
fn place(
    path: &Path,
    header: &[String],
    wanted: &str,
    needed: &[&str],
) -> Result<usize, CaseError> {
    let mut places = header
        .iter()
        .enumerate()
        .filter(|(_, name)| *name == wanted);
    let Some((first, _)) = places.next() else {
        let spare = header.iter().map(String::as_str);
        let spare = spare.filter(|name| !needed.contains(name));
        let help = super::document::nearest(wanted, spare).map_or_else(
            || "add the column; one of the first 200 lines must name the columns".to_owned(),
            |near| format!("did you mean `{near}`? rename it, or add the column"),
        );
        return Err(CaseError::Column {
            path: path.into(),
            column: wanted.into(),
            found: clip(&header.join(", "), 200).into(),
            help: help.into(),
        });
    };
    match places.next() {
        None => Ok(first),
        Some((second, _)) => Err(damaged(
            path,
            format!(
                "column `{wanted}` occurs twice, as columns {} and {}",
                first + 1,
                second + 1
            ),
            "remove or rename one of them",
        )),
    }
}

/// Truncates a text to at most `limit` characters, for messages.
pub fn clip(text: &str, limit: usize) -> String {
    let mut clipped: String = text.chars().take(limit).collect();
    if clipped.len() < text.len() {
        clipped.push('…');
    }
    clipped
}
