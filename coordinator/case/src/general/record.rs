//! Reading of a channel's record: a table of abscissa points and values, cycle by cycle.
use super::{
    super::{
        error::{CaseError, contradiction, damaged},
        file,
        table::CsvTable,
    },
    file::RecordEntry,
};
use exchange::{decoded, table::Table};
use protocol::case::Offset;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Measured record of a channel, as read from its file.
#[derive(Debug)]
pub(super) struct ChannelData {
    /// Abscissa points of the values, ascending.
    pub(super) abscissa: Vec<f64>,
    /// Measured values of each cycle.
    pub(super) cycles: Vec<Vec<f64>>,
    /// Weights of the values; empty if all are equal.
    pub(super) weights: Vec<f64>,
}

/// Tables of a case's records: a file that holds the records of many channels is read once.
#[derive(Debug, Default)]
pub(super) struct Tables(BTreeMap<(PathBuf, Vec<String>), SplitTable>);

/// Table of records.
#[derive(Debug)]
struct SplitTable {
    table: Table,
    /// Rows that have the same text in the column by which the case selects them; all rows under an empty text otherwise.
    rows: BTreeMap<String, Vec<usize>>,
}

impl Tables {
    /// Reads the columns of a record that its entry names.
    fn columns(
        &mut self,
        path: &Path,
        entry: &RecordEntry,
        role: &str,
    ) -> Result<CsvTable, CaseError> {
        let selected = entry.rows.as_ref();
        let named = [Some(&entry.at), Some(&entry.column)].into_iter();
        let named = named.chain([entry.cycle.as_ref(), entry.weight.as_ref()]);
        let named: Vec<&str> = named.flatten().map(String::as_str).collect();
        let needed = named.iter().copied();
        let needed = needed.chain(selected.map(|rows| rows.column.as_str()));
        let needed: Vec<&str> = needed.collect();
        let key = (
            path.to_owned(),
            needed.iter().map(|&name| name.to_owned()).collect(),
        );
        let split = match self.0.entry(key) {
            std::collections::btree_map::Entry::Occupied(known) => known.into_mut(),
            std::collections::btree_map::Entry::Vacant(new) => {
                let bytes = if file::is_packed(path) {
                    file::read_gzip(path, role)?
                } else {
                    file::read(path, role)?
                };
                let table = Table::parse(&decoded(&bytes), &needed);
                let column = selected.map(|rows| &rows.column);
                new.insert(SplitTable {
                    rows: rows_by(path, &table, column)?,
                    table,
                })
            }
        };
        let word = selected.map_or("", |rows| rows.is.as_str());
        match split.rows.get(word) {
            Some(rows) => CsvTable::select(path, &split.table, rows, (&named, &[])),
            None => Err(damaged(
                path,
                format!(
                    "no row has `{word}` in column `{}`",
                    selected.map_or("", |rows| &rows.column)
                ),
                "correct the word in `rows`, or add the rows",
            )),
        }
    }
}

/// Returns the rows of a table by their text in a column; all of them under an empty text if there is no such column.
fn rows_by(
    path: &Path,
    table: &Table,
    column: Option<&String>,
) -> Result<BTreeMap<String, Vec<usize>>, CaseError> {
    let mut rows: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let Some(column) = column else {
        rows.insert(String::new(), (0..table.len()).collect());
        return Ok(rows);
    };
    let Some(at) = table.column(column) else {
        return Err(CaseError::Column {
            path: path.into(),
            column: column.as_str().into(),
            found: table.names.join(", ").into(),
            help: "`rows` names a column of words".into(),
        });
    };
    for row in 0..table.len() {
        let word = table.cell(row, at);
        match rows.get_mut(word) {
            Some(own) => own.push(row),
            None => drop(rows.insert(word.to_owned(), vec![row])),
        }
    }
    Ok(rows)
}

/// Reads a record whose values have an absolute zero or not.
///
/// # Errors
/// Returns an error for a missing file or column, cells that are not numbers, abscissa points that do not
/// ascend or differ between cycles, cycle numbers that are not whole or decrease, weights that are not
/// positive, and unweighted values that are all equal, unless they are residuals: zeros with an absolute zero.
pub(super) fn read(
    tables: &mut Tables,
    path: &Path,
    (entry, offset): (&RecordEntry, Offset),
    role: &str,
) -> Result<ChannelData, CaseError> {
    let table = tables.columns(path, entry, role)?;
    let [at, values, more @ ..] = table.columns.as_slice() else {
        return Ok(ChannelData {
            abscissa: Vec::new(),
            cycles: Vec::new(),
            weights: Vec::new(),
        });
    };
    let numbers = more.first().filter(|_| entry.cycle.is_some());
    let weights = more.last().filter(|_| entry.weight.is_some());
    let begins = begins(path, &table, numbers)?;
    let ends = begins.iter().skip(1).copied().chain([at.len()]);
    let spans: Vec<_> = begins
        .iter()
        .copied()
        .zip(ends)
        .map(|(from, to)| from..to)
        .collect();
    let places = at[spans[0].clone()].to_vec();
    for span in &spans {
        check_places(path, &table, &places, span.start, &at[span.clone()])?;
    }
    let length = places.len();
    if let Some(weights) = weights {
        check_weights(path, &table, weights, length)?;
    }
    let first = values.first().copied().unwrap_or_default();
    let is_residual = first == 0.0 && offset == Offset::Fixed;
    // values that are weighted may be those of different things
    if weights.is_none()
        && !is_residual
        && values.len() > 1
        && values.iter().all(|value| value.total_cmp(&first).is_eq())
    {
        return Err(contradiction(
            path,
            format!("column `{}`", entry.column),
            format!("{first} in every row"),
            "a measured quantity must vary",
            if first == 0.0 {
                "name the column that holds the measurement; if the program returns residuals, whose target is 0, state \
                 offset = \"fixed\""
            } else {
                "name the column that holds the measurement, or leave the record out"
            },
        ));
    }
    let cycles = spans
        .into_iter()
        .map(|span| values[span].to_vec())
        .collect();
    let weights = weights.and_then(|all| all.get(..length));
    Ok(ChannelData {
        abscissa: places,
        cycles,
        weights: weights.unwrap_or_default().to_vec(),
    })
}

/// Checks that the weights are positive and the same in every cycle.
fn check_weights(
    path: &Path,
    table: &CsvTable,
    weights: &[f64],
    length: usize,
) -> Result<(), CaseError> {
    for (row, weight) in weights.iter().enumerate() {
        let first = weights[row % length];
        if *weight > 0.0 && weight.total_cmp(&first).is_eq() {
            continue;
        }
        return Err(table.cell(
            path,
            (row, table.names.len() - 1),
            weight.to_string(),
            "above 0, and in every cycle the same",
            "remove the row of a value that is not to be compared; a channel with `points` and no record predicts its value",
        ));
    }
    Ok(())
}

/// Returns for each cycle of a record the index of the table row at which it begins.
fn begins(
    path: &Path,
    table: &CsvTable,
    numbers: Option<&Vec<f64>>,
) -> Result<Vec<usize>, CaseError> {
    let mut begins = vec![0];
    let Some(numbers) = numbers else {
        return Ok(begins);
    };
    for (row, number) in numbers.iter().enumerate() {
        let before = numbers[row.saturating_sub(1)];
        if number.fract() != 0.0 || *number < before {
            return Err(table.cell(
                path,
                (row, 2),
                number.to_string(),
                format!("a whole number, {before} or above"),
                "number the cycles from 1 on and write one after the other",
            ));
        }
        if *number > before {
            begins.push(row);
        }
    }
    Ok(begins)
}

/// Checks that the abscissa points of a cycle ascend and equal those of the first cycle.
fn check_places(
    path: &Path,
    table: &CsvTable,
    first: &[f64],
    from: usize,
    own: &[f64],
) -> Result<(), CaseError> {
    let falls = own.windows(2).position(|pair| pair[1] <= pair[0]);
    if let Some(at) = falls {
        return Err(table.cell(
            path,
            (from + at + 1, 0),
            own[at + 1].to_string(),
            format!("above {}, the place before it", own[at]),
            "sort the rows of each cycle, and number the cycles in a column that `cycle` names",
        ));
    }
    let other = (0..first.len().max(own.len())).find(|&at| first.get(at) != own.get(at));
    let Some(at) = other else { return Ok(()) };
    let row = from + at.min(own.len() - 1);
    let said = own
        .get(at)
        .map_or("the end of the cycle".to_owned(), f64::to_string);
    Err(table.cell(
        path,
        (row, 0),
        said,
        first
            .get(at)
            .map_or("the end of the cycle".to_owned(), f64::to_string)
            + ", as in the first cycle",
        "interpolate every cycle to the same places before it is written",
    ))
}
