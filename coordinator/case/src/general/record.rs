//! Reading of a channel's record: a table of abscissa points and values, cycle by cycle.
use super::{
    super::{
        error::{CaseError, contradiction, damaged},
        file,
        table::CsvTable,
    },
    file::RecordEntry,
};
use exchange::{decoded, table::TextTable};
use std::{
    collections::{BTreeMap, BTreeSet, btree_map::Entry},
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
#[derive(Debug)]
pub(super) struct Tables {
    /// Names of the columns of numbers that the case needs of each file, by the path that it states.
    needed: BTreeMap<PathBuf, BTreeSet<String>>,
    /// Tables that have been read.
    read: BTreeMap<PathBuf, TextTable>,
    /// Rows of a table by their text in a column by which the case selects them.
    rows: BTreeMap<(PathBuf, String), BTreeMap<String, Vec<usize>>>,
}

impl Tables {
    /// Creates an empty store for the records of some channels.
    pub(super) fn new(entries: &[&RecordEntry]) -> Self {
        let mut needed: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
        for entry in entries {
            let of_file = needed.entry(entry.file.clone()).or_default();
            of_file.extend(columns(entry).map(str::to_owned));
        }
        Self {
            needed,
            read: BTreeMap::new(),
            rows: BTreeMap::new(),
        }
    }

    /// Reads the columns of a record that its entry names.
    fn columns(
        &mut self,
        path: &Path,
        entry: &RecordEntry,
        role: &str,
    ) -> Result<CsvTable, CaseError> {
        let named: Vec<&str> = columns(entry).collect();
        if !self.read.contains_key(path) {
            let bytes = if file::is_packed(path) {
                file::read_gzip(path, role)?
            } else {
                file::read(path, role)?
            };
            let all = self.needed.get(&entry.file).into_iter().flatten();
            let all: Vec<&str> = all.map(String::as_str).collect();
            let text = decoded(&bytes);
            let mut table = TextTable::parse(&text, &all);
            // a name that another channel misspells must not hide the header from this one
            if named.iter().any(|name| table.column(name).is_none()) {
                table = TextTable::parse(&text, &named);
            }
            self.read.insert(path.to_owned(), table);
        }
        let Some(table) = self.read.get(path) else {
            return Err(damaged(path, "the file was not read", "try again"));
        };
        let Some(selected) = &entry.rows else {
            let rows: Vec<usize> = (0..table.len()).collect();
            return CsvTable::select(path, table, &rows, (&named, &[]));
        };
        let key = (path.to_owned(), selected.column.clone());
        let rows = match self.rows.entry(key) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert(rows_by(path, table, &selected.column)?),
        };
        match rows.get(&selected.is) {
            Some(rows) => CsvTable::select(path, table, rows, (&named, &[])),
            None => Err(damaged(
                path,
                format!(
                    "no row has `{}` in column `{}`",
                    selected.is, selected.column
                ),
                "correct the word in `rows`, or add the rows",
            )),
        }
    }
}

/// Returns the names of the columns of numbers that a record has: abscissa, values, cycles, weights.
fn columns(entry: &RecordEntry) -> impl Iterator<Item = &str> {
    let named = [Some(&entry.at), Some(&entry.column)].into_iter();
    let named = named.chain([entry.cycle.as_ref(), entry.weight.as_ref()]);
    named.flatten().map(String::as_str)
}

/// Returns the rows of a table by their text in a column.
fn rows_by(
    path: &Path,
    table: &TextTable,
    column: &str,
) -> Result<BTreeMap<String, Vec<usize>>, CaseError> {
    let mut rows: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let Some(at) = table.column(column) else {
        return Err(CaseError::Column {
            path: path.into(),
            column: column.into(),
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

/// Reads a record.
///
/// # Errors
/// Returns an error for a missing file or column, cells that are not numbers, abscissa points that do not
/// ascend or differ between cycles, cycle numbers that are not whole or decrease, weights that are not
/// positive, and unweighted values that are all equal unless they `may_be_constant`: limits, and the zeros with which residuals
/// are compared.
pub(super) fn read(
    tables: &mut Tables,
    path: &Path,
    (entry, may_be_constant): (&RecordEntry, bool),
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
    // values that are weighted may be those of different things
    if weights.is_none()
        && !may_be_constant
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
