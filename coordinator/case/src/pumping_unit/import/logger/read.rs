//! Reading of the requested columns of a table of known layout.
use super::{
    clock::{self, Clock},
    columns::Columns,
    layout::{Cells, Layout, is_comment, switch},
    lines::Lines,
};
use crate::{
    error::{CaseError, damaged},
    table::clip,
};
use exchange::utf8_or_latin1;
use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
};

/// Numbers of the requested columns of a file, or of several that continue each other.
#[derive(Debug)]
pub(crate) struct Table {
    /// First row and path of each file.
    pub(crate) files: Vec<(usize, PathBuf)>,
    /// Time of each row \[s\], strictly ascending.
    pub(crate) time_s: Vec<f64>,
    /// Numbers of each requested column, in the order of the request; NaN where a value is missing.
    pub(crate) columns: Vec<Vec<f64>>,
    /// Line of each row in the file.
    pub(crate) lines: Vec<u32>,
    /// Number of rows that lack a cell and were left out; in a table with times they are an error.
    pub(crate) short: usize,
    /// Cells of the requested columns that [`survey`] found to be no numbers, different ones with their first
    /// line.
    pub(crate) words: Vec<(u64, String)>,
}

/// Largest number of columns that are read at once: an angle and the curves of a record.
const MOST_VALUES: usize = 16;

/// Largest number of different cells that a survey lists.
const WORDS: usize = 12;

/// Step to a number that stands for a missing value, relative to the one that nine of ten steps stay below.
const JUMP: f64 = 20.0;

/// Numbers that programs write for a missing value.
const SENTINELS: [f64; 8] = [
    -9999.0, 9999.0, -999.0, -99999.0, 99999.0, -32768.0, 32767.0, 1e30,
];

/// Largest gap between files that continue each other, in steps of the time.
const CONTINUES: f64 = 5.0;

/// Time between recordings that do not continue each other \[s\]: longer than any turn.
const APART: f64 = 3600.0;

impl Table {
    /// Returns the file and the line of a row.
    pub(crate) fn place(&self, row: usize) -> (&Path, u32) {
        let file = self.files.iter().rfind(|(first, _)| *first <= row);
        let path = file
            .or(self.files.first())
            .map_or(Path::new(""), |(_, path)| path);
        (path, self.lines.get(row).copied().unwrap_or_default())
    }

    /// Creates an error about a cell of a row.
    pub(crate) fn fault(
        &self,
        row: usize,
        column: &str,
        value: String,
        allowed: &str,
        help: &str,
    ) -> CaseError {
        let (path, line) = self.place(row);
        CaseError::Cell {
            path: path.into(),
            row: u64::from(line),
            column: column.into(),
            value: value.into(),
            allowed: allowed.into(),
            help: help.into(),
        }
    }

    /// Appends a table. Its times stay where they follow without a gap; else it is another recording, and is
    /// moved to an hour later.
    pub(crate) fn append(&mut self, other: Self) {
        let rows = self.time_s.len();
        let first = self.time_s.first().copied().unwrap_or_default();
        let last = self.time_s.last().copied().unwrap_or_default();
        let next = other.time_s.first().copied().unwrap_or_default();
        let step = (last - first) / (rows.max(2) as f64 - 1.0);
        let shift = if next > last && next - last < CONTINUES * step {
            0.0
        } else {
            last + APART - next
        };
        let files = other.files.into_iter();
        self.files
            .extend(files.map(|(first, path)| (rows + first, path)));
        self.time_s
            .extend(other.time_s.iter().map(|time| time + shift));
        self.lines.extend(other.lines);
        for (column, more) in self.columns.iter_mut().zip(other.columns) {
            column.extend(more);
        }
    }

    /// Returns the numbers that stand for missing values in a column, as text: a known one that
    /// is reached and left by jumps alone.
    pub(crate) fn sentinels(&self) -> Vec<String> {
        let stands_apart = |sentinel: &f64, column: &Vec<f64>| {
            let is = |value: f64| (value - sentinel).abs() < 1e-9 * sentinel.abs();
            let known: Vec<f64> = column
                .iter()
                .copied()
                .filter(|value| !value.is_nan())
                .collect();
            let mut steps: Vec<f64> = known
                .windows(2)
                .filter(|pair| !is(pair[0]) && !is(pair[1]))
                .map(|pair| (pair[1] - pair[0]).abs())
                .collect();
            steps.sort_by(f64::total_cmp);
            let usual = steps.get(steps.len() * 9 / 10).copied().unwrap_or_default();
            // it is reached and left by jumps alone
            let edges = known.windows(2).filter(|pair| is(pair[0]) != is(pair[1]));
            let mut jumps = edges.map(|pair| (pair[1] - pair[0]).abs() > JUMP * usual);
            known.iter().any(|value| is(*value)) && jumps.all(|jump| jump)
        };
        let stands = |sentinel: &&f64| {
            self.columns
                .iter()
                .any(|column| stands_apart(sentinel, column))
        };
        SENTINELS
            .iter()
            .filter(stands)
            .map(ToString::to_string)
            .collect()
    }
}

/// Columns of a row that are read, with the place of each.
struct Wanted<'a> {
    path: &'a Path,
    layout: &'a Layout,
    time: Option<Clock<'a>>,
    /// Place and name of each column of the time.
    times: Vec<(usize, &'a str)>,
    /// Place and name of each requested column.
    values: Vec<(usize, &'a str)>,
    /// Number of columns of the table.
    width: usize,
    /// Number of cells of the first row.
    usual: usize,
    /// Line of the names, which may be repeated where a recording was continued.
    header: Vec<u8>,
    /// Numbers that stand for missing values.
    missing: Vec<f64>,
    /// Whether cells that are no numbers are listed in place of an error.
    survey: bool,
}

/// Reads the requested columns of a file, and the time of each row; without a statement of the time it is the
/// number of the row.
///
/// # Errors
/// Returns an error with line and column for a cell that is neither a number nor a missing value, a row that
/// is cut off, and times that repeat or decrease.
pub(crate) fn read(
    path: &Path,
    layout: &Layout,
    time: Option<Clock<'_>>,
    wanted: &[&str],
) -> Result<Table, CaseError> {
    read_with(path, layout, time, wanted, false)
}

/// Reads the requested columns of a file that may have faults, for a proposal of its mapping: cells that are
/// no numbers become missing values and are listed.
///
/// # Errors
/// Returns an error for a file that cannot be read, and a column that does not exist.
pub(crate) fn survey(path: &Path, layout: &Layout, wanted: &[&str]) -> Result<Table, CaseError> {
    read_with(path, layout, None, wanted, true)
}

fn read_with(
    path: &Path,
    layout: &Layout,
    time: Option<Clock<'_>>,
    wanted: &[&str],
    survey: bool,
) -> Result<Table, CaseError> {
    let columns = Columns::read(path, layout)?;
    let place = |name: &&'_ str| columns.place(path, name);
    let names: Vec<&str> = match time {
        Some(Clock::Elapsed(column, _)) => vec![column],
        Some(Clock::Calendar(columns, _, milliseconds)) => columns
            .iter()
            .map(String::as_str)
            .chain(milliseconds)
            .collect(),
        Some(Clock::Steps(_)) | None => Vec::new(),
    };
    let places = |names: &[&str]| names.iter().map(place).collect::<Result<Vec<_>, _>>();
    let wanted = Wanted {
        path,
        layout,
        time,
        times: places(&names)?
            .into_iter()
            .zip(names.iter().copied())
            .collect(),
        values: places(wanted)?
            .into_iter()
            .zip(wanted.iter().copied())
            .collect(),
        width: columns.names.len(),
        usual: columns.usual,
        header: columns.header,
        missing: {
            let words = layout.missing.iter();
            words
                .filter_map(|word| layout.number(word.as_bytes()))
                .collect()
        },
        survey,
    };
    let mut table = Table {
        files: vec![(0, path.to_owned())],
        time_s: Vec::new(),
        columns: vec![Vec::new(); wanted.values.len()],
        lines: Vec::new(),
        words: Vec::new(),
        short: 0,
    };
    let mut lines = Lines::open(path)?;
    let mut cells = Cells::default();
    let mut held: VecDeque<(u64, Vec<u8>)> = VecDeque::new();
    while let Some((number, line)) = lines.next()? {
        if number < layout.first_line || is_comment(line) || wanted.repeats_header(number, line) {
            continue;
        }
        if layout.footer_lines == 0 {
            wanted.row(number, line, &mut cells, &mut table)?;
            continue;
        }
        // the last lines are no rows, and which are the last is known at the end
        held.push_back((number, line.to_owned()));
        if held.len() as u64 > layout.footer_lines
            && let Some((number, line)) = held.pop_front()
        {
            wanted.row(number, &line, &mut cells, &mut table)?;
        }
    }
    // of several files one may have no footer
    for (number, line) in held {
        if wanted.row(number, &line, &mut cells, &mut table).is_err() {
            break;
        }
    }
    if table.lines.is_empty() {
        return Err(damaged(
            path,
            "it has no rows of data",
            "correct `table` in the mapping, or copy the file again",
        ));
    }
    wanted.finish(&mut table)?;
    Ok(table)
}

impl Wanted<'_> {
    /// Returns whether a line is the header once more.
    fn repeats_header(&self, number: u64, line: &[u8]) -> bool {
        let header = self.layout.header_line;
        header.is_some_and(|own| own != number) && !self.header.is_empty() && line == self.header
    }

    /// Reads a row.
    fn row(
        &self,
        number: u64,
        line: &[u8],
        cells: &mut Cells,
        table: &mut Table,
    ) -> Result<(), CaseError> {
        self.layout.delimiter.split(line, cells);
        let filled = cells.filled();
        let cut = cells.len() < self.usual;
        if cut && self.time.is_none() && !self.survey {
            table.short += 1;
            return Ok(());
        }
        if (filled > self.width || cut) && !self.survey {
            return Err(self.fault(
                (number, ""),
                format!("a row of {} cells", if cut { cells.len() } else { filled }),
                format!("{} cells, as in the first row", self.usual),
                if cut {
                    "if the file ends here it was cut off: copy it again, or leave the row out by \
                     `footer_lines = 1` in `[table]` of the mapping; else write the missing cell into a copy"
                } else {
                    "a decimal comma or a stray separator cuts a cell in two: correct `table.delimiter` and \
                     `table.decimal` in the mapping"
                },
            ));
        }
        let rows = table.time_s.len();
        let time = match self.time {
            None => rows as f64,
            Some(Clock::Steps(step)) => rows as f64 * step,
            Some(clock) => self.time(clock, number, cells)?,
        };
        // a row that is no data must not leave half of its values
        let mut values = [f64::NAN; MOST_VALUES];
        for (value, &(place, name)) in values.iter_mut().zip(&self.values) {
            let cell = match self.cell((number, name), place, cells) {
                Err(_) if self.survey => b"",
                cell => cell?,
            };
            *value = match self.value((number, name), cell) {
                Err(_) if self.survey => {
                    let word = utf8_or_latin1(cell).into_owned();
                    let known = table.words.iter().any(|(_, other)| *other == word);
                    if !known && table.words.len() < WORDS {
                        table.words.push((number, word));
                    }
                    f64::NAN
                }
                value => value?,
            };
        }
        table.time_s.push(time);
        for (column, value) in table.columns.iter_mut().zip(values) {
            column.push(value);
        }
        table.lines.push(u32::try_from(number).unwrap_or(u32::MAX));
        Ok(())
    }

    /// Returns the time of a row.
    fn time(&self, clock: Clock<'_>, number: u64, cells: &Cells) -> Result<f64, CaseError> {
        let name = self.times.first().map_or("", |(_, name)| name);
        let (columns, format) = match clock {
            Clock::Steps(_) => return Ok(0.0),
            Clock::Elapsed(_, factor) => {
                let place = self.times.first().map_or(0, |(place, _)| *place);
                let cell = self.cell((number, name), place, cells)?;
                return Ok(self.number((number, name), cell)? * factor);
            }
            Clock::Calendar(columns, format, _) => (columns, format),
        };
        let (clock, more) = self.times.split_at(columns.len());
        let mut written = String::new();
        for &(place, name) in clock {
            let cell = self.cell((number, name), place, cells)?;
            if !written.is_empty() {
                written.push(' ');
            }
            written.push_str(&utf8_or_latin1(cell));
        }
        let mut seconds = clock::seconds(format, &written, self.layout).ok_or_else(|| {
            self.fault(
                (number, name),
                format!("`{}`", clip(&written, 40)),
                format!("a time of the format `{format}`"),
                "correct `time.format` in the mapping, or the row; if the data end before it, state \
                 `footer_lines` in `[table]`",
            )
        })?;
        for &(place, name) in more {
            let cell = self.cell((number, name), place, cells)?;
            seconds += 1e-3 * self.number((number, name), cell)?;
        }
        Ok(seconds)
    }

    /// Returns a cell of a row; an error where the row ends before it.
    fn cell<'c>(
        &self,
        at: (u64, &str),
        place: usize,
        cells: &'c Cells,
    ) -> Result<&'c [u8], CaseError> {
        cells.get(place).ok_or_else(|| {
            self.fault(
                at,
                format!("a row that ends after {} cells", cells.len()),
                format!("at least {} cells", place + 1),
                "if the file ends here it was cut off: copy it again, or leave the row out by \
                 `table.footer_lines = 1` in the mapping",
            )
        })
    }

    /// Returns the number of a cell; NaN where it stands for a missing value.
    fn value(&self, at: (u64, &str), cell: &[u8]) -> Result<f64, CaseError> {
        let value = match self.number(at, cell) {
            Err(_) if self.layout.is_missing(cell) => return Ok(f64::NAN),
            value => value?,
        };
        let is = |other: &f64| (value - other).abs() <= 1e-9 * other.abs();
        Ok(if self.missing.iter().any(is) {
            f64::NAN
        } else {
            value
        })
    }

    fn number(&self, at: (u64, &str), cell: &[u8]) -> Result<f64, CaseError> {
        self.layout.number(cell).or_else(|| switch(cell)).ok_or_else(|| {
            self.fault(
                at,
                format!("`{}`", clip(&utf8_or_latin1(cell), 40)),
                format!("a number with `{}` as decimal sign", self.layout.decimal),
                "if it stands for a missing value, add it to `table.missing` in the mapping; if it is a number, \
                 correct `table.decimal` and `table.thousands`; if the data end before it, state \
                 `table.footer_lines`",
            )
        })
    }

    fn fault(
        &self,
        (line, column): (u64, &str),
        value: String,
        allowed: String,
        help: &str,
    ) -> CaseError {
        CaseError::Cell {
            path: self.path.into(),
            row: line,
            column: column.into(),
            value: value.into(),
            allowed: allowed.into(),
            help: help.into(),
        }
    }

    /// Removes the passing of midnight and checks that the times ascend.
    fn finish(&self, table: &mut Table) -> Result<(), CaseError> {
        if let Some(Clock::Calendar(_, format, _)) = self.time
            && !format.contains("%d")
        {
            clock::over_midnight(&mut table.time_s);
        }
        let pairs = table.time_s.iter().zip(table.time_s.iter().skip(1));
        let Some((row, (before, after))) = pairs.enumerate().find(|(_, (a, b))| b <= a) else {
            return Ok(());
        };
        let line = table.lines.get(row + 1).copied().unwrap_or_default();
        let name = self.times.first().map_or("", |(_, name)| name);
        let span = table.time_s.last().copied().unwrap_or_default()
            - table.time_s.first().copied().unwrap_or_default();
        let repeated = table.time_s.windows(2).filter(|pair| pair[0] >= pair[1]);
        let (value, help) = if after < before {
            (
                format!("{:.3} s before the row above", before - after),
                "the clock was set while it recorded: split the file there and import the parts, or state \
                 `rate_hz` alone in `[time]` of the mapping"
                    .to_owned(),
            )
        } else if 2 * repeated.count() > table.lines.len() && span > 0.0 {
            // the rows of the last reading of the clock are as many as of any other
            let tick = table.time_s.windows(2).map(|pair| pair[1] - pair[0]);
            let tick = tick
                .filter(|step| *step > 0.0)
                .fold(f64::INFINITY, f64::min);
            let rate = (table.lines.len() as f64 / (span + tick)).round();
            (
                "the same time as the row above, like most rows".to_owned(),
                format!(
                    "the clock is coarser than the sampling: state `rate_hz` alone in `[time]` of the mapping \
                     (there are about {rate} rows a second, with lost ones somewhat more), or add the column \
                     with the milliseconds"
                ),
            )
        } else {
            (
                "the same time as the row above".to_owned(),
                "remove the repeated row from a copy, or state the sampling rate by \
                 `time = { rate_hz = .. }` in the mapping"
                    .to_owned(),
            )
        };
        Err(self.fault(
            (u64::from(line), name),
            value,
            "a later time in each row".to_owned(),
            &help,
        ))
    }
}
