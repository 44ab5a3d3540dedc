//! Tables of numbers in CSV files: named columns, finite numbers, rows counted as lines of the file.
use super::{
    error::{CaseError, damaged},
    file::decoded,
};
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
        let bytes = decoded(bytes);
        let (mut reader, comma) = reader(&bytes);
        let mut record = csv::ByteRecord::new();
        let header = header(path, &mut reader, &mut record)?;
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
            .map(|name| place(path, &header, name, &wanted))
            .collect::<Result<Vec<usize>, CaseError>>()?;
        let mut table = Self {
            columns: vec![Vec::new(); wanted.len()],
            lines: Vec::new(),
            names: wanted.iter().map(|&name| name.to_owned()).collect(),
            others: {
                let other = |name: &&String| !wanted.contains(&name.as_str());
                header.iter().filter(other).cloned().collect()
            },
        };
        while advance(path, &mut reader, &mut record)? {
            let line = record.position().map_or(0, csv::Position::line);
            if record.len() != header.len() {
                return Err(CaseError::Cell {
                    path: path.into(),
                    row: line,
                    column: header.last().map_or("", String::as_str).into(),
                    value: format!("a row of {} cells", record.len()).into(),
                    allowed: format!("{} cells, as in the header", header.len()).into(),
                    help: if comma == b',' && record.len() > header.len() {
                        "a decimal comma cuts a cell in two: write decimal points, or separate the cells by \
                         semicolons"
                            .into()
                    } else {
                        "the row is cut off or has a stray separator: correct or remove it".into()
                    },
                });
            }
            for ((column, &at), name) in table.columns.iter_mut().zip(&places).zip(&wanted) {
                let cell = record.get(at).unwrap_or_default();
                column.push(number(path, (line, name), cell, comma)?);
            }
            table.lines.push(line);
        }
        if table.lines.is_empty() {
            return Err(damaged(
                path,
                "the table has a header but no rows",
                "copy the file again from its source",
            ));
        }
        Ok(table)
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

/// Returns the column names in the header of a CSV file.
///
/// # Errors
/// A first row that cannot be read.
pub fn columns(path: &Path, bytes: &[u8]) -> Result<Vec<String>, CaseError> {
    let bytes = decoded(bytes);
    header(path, &mut reader(&bytes).0, &mut csv::ByteRecord::new())
}

/// Returns a CSV reader and its delimiter: a comma, unless the first row has none but has a semicolon or a
/// tab.
fn reader(bytes: &[u8]) -> (csv::Reader<&[u8]>, u8) {
    let first = bytes
        .split(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    let has = |byte: &&u8| first.contains(*byte);
    let between = *[b',', b';', b'\t'].iter().find(has).unwrap_or(&b',');
    let reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(between)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    (reader, between)
}

/// Reads the column names from the first row of a CSV file.
fn header(
    path: &Path,
    reader: &mut csv::Reader<&[u8]>,
    record: &mut csv::ByteRecord,
) -> Result<Vec<String>, CaseError> {
    advance(path, reader, record)?;
    let name = |cell: &[u8]| {
        String::from_utf8_lossy(cell)
            .trim_start_matches(['#', '\u{feff}', ' '])
            .to_owned()
    };
    Ok(record.iter().map(name).collect())
}

/// Reads the next row of the CSV table; returns false at the end.
fn advance(
    path: &Path,
    reader: &mut csv::Reader<&[u8]>,
    record: &mut csv::ByteRecord,
) -> Result<bool, CaseError> {
    reader.read_byte_record(record).map_err(|error| {
        let line = error.position().map_or(0, csv::Position::line);
        damaged(
            path,
            format!("line {line} cannot be read as CSV: {error}"),
            "use commas between cells and no line breaks in quotes",
        )
    })
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
            || {
                "add the column; the first row must name the columns, separated by commas"
                    .to_owned()
            },
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

/// Parses a cell as a finite number; a decimal comma is accepted where the delimiter is not a comma.
fn number(
    path: &Path,
    (line, name): (u64, &str),
    cell: &[u8],
    between: u8,
) -> Result<f64, CaseError> {
    let text = std::str::from_utf8(cell).unwrap_or_default();
    let point = if between == b',' {
        text.parse::<f64>()
    } else {
        text.replacen(',', ".", 1).parse::<f64>()
    };
    let problem = match point {
        Ok(value) if value.is_finite() => return Ok(value),
        Ok(_) => "interpolate the value or remove the row: lost samples are allowed, NaN is not",
        Err(_) if cell.is_empty() => {
            "remove the row: lost samples are allowed, empty cells are not"
        }
        Err(_) => "write a plain number with a decimal point, without its unit",
    };
    Err(CaseError::Cell {
        path: path.into(),
        row: line,
        column: name.into(),
        value: format!("`{}`", clip(&String::from_utf8_lossy(cell), 40)).into(),
        allowed: "a finite number".into(),
        help: problem.into(),
    })
}

/// Truncates a text to at most `limit` characters, for messages.
pub fn clip(text: &str, limit: usize) -> String {
    let mut clipped: String = text.chars().take(limit).collect();
    if clipped.len() < text.len() {
        clipped.push('…');
    }
    clipped
}
