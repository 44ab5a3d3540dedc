//! Reading of tables with a header: records of loggers and results of programs.
use crate::{Problem, number, problem::clip};
use std::ops::Range;

/// Number of lines among which the header is searched for.
const PREAMBLE: usize = 200;

/// Table of text cells under a header.
///
/// The header is the first line that contains all needed names, separated by commas, semicolons, tabs or blanks, optionally
/// after a `#`; lines before it are a preamble of the program that wrote the table. A row of units below the header is left
/// out, as are empty rows.
#[derive(Clone, Debug)]
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Rows of the table, in the order of the file.
    rows: Vec<Row>,
    /// Texts of all cells one after the other: a record of some hours has a hundred million.
    text: String,
    /// End of each cell in the text.
    ends: Vec<usize>,
    separator: Separator,
}

/// Row of a table: its line in the file, and its cells.
#[derive(Clone, Debug)]
struct Row {
    line: usize,
    cells: Range<usize>,
}

/// Fault in one cell or row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellProblem {
    /// Line number of the row in the file, from 1.
    pub line: usize,
    /// Name of the column.
    pub column: String,
    /// Text found.
    pub found: String,
    /// Description of the text that is allowed there.
    pub allowed: String,
    /// Action that corrects the fault.
    pub remedy: &'static str,
}

/// Character between the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Byte(u8),
    Blanks,
}

impl Separator {
    const ALL: [Self; 4] = [
        Self::Byte(b','),
        Self::Byte(b';'),
        Self::Byte(b'\t'),
        Self::Blanks,
    ];

    fn is_in(self, line: &str) -> bool {
        match self {
            Self::Byte(byte) => line.as_bytes().contains(&byte),
            Self::Blanks => true,
        }
    }

    /// Calls a function for every row of a text, with the number of its line in the text and its cells; stops when it
    /// returns false.
    fn each_row(
        self,
        text: &str,
        mut row: impl FnMut(usize, &mut dyn Iterator<Item = &str>) -> bool,
    ) {
        match self {
            Self::Byte(byte) => {
                let mut reader = csv::ReaderBuilder::new()
                    .has_headers(false)
                    .flexible(true)
                    .delimiter(byte)
                    .trim(csv::Trim::All)
                    .from_reader(text.as_bytes());
                let (mut lines, mut record) = (Lines::new(text), csv::StringRecord::new());
                // text in memory can neither fail to be read nor be anything but UTF-8
                while reader.read_record(&mut record).unwrap_or(false) {
                    let at = record.position().map_or(0, csv::Position::byte);
                    let line = lines.of(usize::try_from(at).unwrap_or(usize::MAX));
                    if !row(line, &mut record.iter()) {
                        return;
                    }
                }
            }
            Self::Blanks => {
                for (at, line) in text.lines().enumerate() {
                    let mut words = line.split_whitespace().map(|word| word.trim_matches('"'));
                    if !row(at + 1, &mut words) {
                        return;
                    }
                }
            }
        }
    }
}

/// Numbers of the lines at ascending positions of a text.
struct Lines<'a> {
    text: &'a str,
    counted: usize,
    line: usize,
}

impl<'a> Lines<'a> {
    const fn new(text: &'a str) -> Self {
        Self {
            text,
            counted: 0,
            line: 1,
        }
    }

    /// Returns the number of the first line with content from a position on: the position of a record is that behind the
    /// record before it, with the empty lines between the two.
    fn of(&mut self, from: usize) -> usize {
        let rest = self.text.get(from..).unwrap_or_default();
        let at = self.text.len() - rest.trim_start_matches(['\n', '\r']).len();
        let passed = self.text.get(self.counted..at).unwrap_or_default();
        self.line += passed.matches('\n').count();
        self.counted = at;
        self.line
    }
}

fn header_names(line: &str, separator: Separator) -> Vec<String> {
    let line = line.trim_start_matches(['\u{feff}', '#', ' ']);
    let mut names = Vec::new();
    separator.each_row(line, |_, cells| {
        names.extend(cells.map(str::to_owned));
        false
    });
    names
}

impl Table {
    /// Splits a text into a table; `needed` are names that the header must contain. Without a line that contains them the
    /// first line that is not empty is the header.
    pub fn parse(text: &str, needed: &[&str]) -> Self {
        let text = text.trim_start_matches('\u{feff}');
        let has_all = |names: &[String]| needed.iter().all(|name| names.iter().any(|n| n == name));
        let filled = || {
            let lines = text.split_inclusive('\n').enumerate();
            lines.filter(|(_, line)| !line.trim().is_empty())
        };
        let header = filled().take(PREAMBLE).find_map(|(at, line)| {
            let mut between = Separator::ALL.into_iter();
            let found = between.find(|it| it.is_in(line) && has_all(&header_names(line, *it)))?;
            Some((at, found))
        });
        let header = header.or_else(|| {
            let (at, line) = filled().next()?;
            let mut between = Separator::ALL.into_iter();
            Some((at, between.find(|it| it.is_in(line))?))
        });
        let mut table = Self {
            names: Vec::new(),
            rows: Vec::new(),
            text: String::new(),
            ends: Vec::new(),
            separator: Separator::Byte(b','),
        };
        let Some((at, separator)) = header else {
            return table;
        };
        let mut lines = text.split_inclusive('\n');
        let before: usize = lines.by_ref().take(at).map(str::len).sum();
        let line = lines.next().unwrap_or_default();
        table.names = header_names(line, separator);
        table.separator = separator;
        let rest = text.get(before + line.len()..).unwrap_or_default();
        separator.each_row(rest, |line, cells| {
            let (first, empty) = (table.ends.len(), table.text.len());
            for cell in cells {
                table.text.push_str(cell);
                table.ends.push(table.text.len());
            }
            if table.text.len() > empty {
                let line = at + 1 + line;
                let cells = first..table.ends.len();
                table.rows.push(Row { line, cells });
            } else {
                table.ends.truncate(first);
            }
            true
        });
        if table.has_units(needed) {
            table.rows.remove(0);
        }
        table
    }

    /// Returns the index of the column with a name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|own| own == name)
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether the table has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns the line number in the file of a row, from 1.
    pub fn line(&self, row: usize) -> usize {
        self.rows.get(row).map_or(0, |row| row.line)
    }

    /// Returns the text of a cell; an empty text if the row is too short.
    pub fn cell(&self, row: usize, column: usize) -> &str {
        let mut cells = self.rows.get(row).map_or(0..0, |row| row.cells.clone());
        let Some(at) = cells.nth(column) else {
            return "";
        };
        let from = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.text.get(from..self.ends[at]).unwrap_or_default()
    }

    /// Returns the number of cells in a row.
    fn width(&self, row: usize) -> usize {
        self.rows.get(row).map_or(0, |row| row.cells.len())
    }

    /// Returns whether a comma separates the cells, so that numbers have decimal points.
    pub fn is_comma_separated(&self) -> bool {
        self.separator == Separator::Byte(b',')
    }

    /// Returns whether the first row holds the units of the needed columns: words in all of them, above numbers.
    fn has_units(&self, needed: &[&str]) -> bool {
        /// Words that loggers write in place of a lost value.
        const LOST: [&str; 8] = ["nan", "inf", "+inf", "-inf", "na", "n/a", "null", "none"];
        let all = |of: &dyn Fn(usize) -> bool| {
            let mut columns = needed.iter().filter_map(|name| self.column(name));
            columns.all(of)
        };
        let is_word = |column| {
            let cell = self.cell(0, column);
            let is_lost = LOST.contains(&cell.to_lowercase().as_str());
            !cell.is_empty() && !is_lost && self.number(cell).is_none()
        };
        !needed.is_empty()
            && self.rows.len() > 1
            && self.width(0) == self.names.len()
            && all(&is_word)
            && all(&|column| self.number(self.cell(1, column)).is_some())
    }

    /// Parses a cell as a finite number. A decimal comma is accepted where commas do not separate cells, and blanks behind
    /// a sign.
    fn number(&self, cell: &str) -> Option<f64> {
        let plain = cell.trim();
        let signed = plain.strip_prefix(['+', '-']).and_then(|rest| {
            let sign = plain.get(..1)?;
            rest.starts_with(' ')
                .then(|| format!("{sign}{}", rest.trim_start()))
        });
        let plain = signed.as_deref().unwrap_or(plain);
        if self.is_comma_separated() || !plain.contains(',') {
            return number(plain);
        }
        number(&plain.replacen(',', ".", 1))
    }

    /// Returns the numbers of a column in the given rows.
    ///
    /// # Errors
    /// A row of another length than the header, a cell that is not a finite number, and commas or points that separate
    /// thousands.
    pub fn numbers(&self, column: usize, rows: &[usize]) -> Result<Vec<f64>, CellProblem> {
        let name = self.names.get(column).cloned().unwrap_or_default();
        let wrong = |row: usize, found: String, allowed: &str, remedy| CellProblem {
            line: self.line(row),
            column: name.clone(),
            found,
            allowed: allowed.to_owned(),
            remedy,
        };
        let quoted = |row: usize| format!("`{}`", clip(self.cell(row, column)));
        let mut values = Vec::with_capacity(rows.len());
        for &row in rows {
            let length = self.width(row);
            if length != self.names.len() {
                let remedy = if self.is_comma_separated() && length > self.names.len() {
                    "a decimal comma cuts a cell in two: write decimal points, or separate the cells by semicolons"
                } else {
                    "the row is cut off or has a stray separator: correct or remove it"
                };
                return Err(CellProblem {
                    line: self.line(row),
                    column: self.names.last().cloned().unwrap_or_default(),
                    found: format!("a row of {length} cells"),
                    allowed: format!("{} cells, as in the header", self.names.len()),
                    remedy,
                });
            }
            let cell = self.cell(row, column);
            let value = self.number(cell).ok_or_else(|| {
                let remedy = if grouped(cell, ',') || grouped(cell, '.') {
                    THOUSANDS
                } else if cell.is_empty() {
                    "remove the row: lost samples are allowed, empty cells are not"
                } else if cell.parse::<f64>().is_ok() {
                    "interpolate the value or remove the row: lost samples are allowed, NaN is not"
                } else {
                    "write a plain number with a decimal point, without its unit"
                };
                wrong(row, quoted(row), "a finite number", remedy)
            })?;
            values.push(value);
        }
        let separated = rows
            .iter()
            .copied()
            .find(|row| self.cell(*row, column).contains([',', '.']));
        match separated {
            Some(row) if self.separates_thousands(column, rows, &values) => Err(wrong(
                row,
                quoted(row),
                "a number without separated thousands",
                THOUSANDS,
            )),
            _ => Ok(values),
        }
    }

    /// Returns whether commas or points in a column separate thousands: all numbers that have one look like that, and either
    /// the table has the other mark for its decimals, or the column does not jump when they are read so.
    fn separates_thousands(&self, column: usize, rows: &[usize], read: &[f64]) -> bool {
        [(',', '.'), ('.', ',')].into_iter().any(|(mark, other)| {
            let cells = || rows.iter().map(|row| self.cell(*row, column));
            let marked = || cells().filter(move |cell| cell.contains(mark));
            if marked().next().is_none() || !marked().all(|cell| grouped(cell, mark)) {
                return false;
            }
            let is_decimal = |cell: &str| {
                cell.contains(other) && !cell.contains(mark) && self.number(cell).is_some()
            };
            let whole = |cell: &str| cell.bytes().filter(u8::is_ascii_digit).count() == 3;
            let plain = cells().any(|cell| !cell.contains([mark, other]) && whole(cell));
            let joined = cells().map(|cell| number(&cell.replace(mark, "")));
            let joined: Option<Vec<f64>> = joined.collect();
            let columns = 0..self.names.len();
            let mut all = columns.flat_map(|it| rows.iter().map(move |row| self.cell(*row, it)));
            (mark == ',' && all.any(is_decimal))
                || (plain && joined.is_some_and(|joined| jump(&joined) < jump(read)))
        })
    }
}

const THOUSANDS: &str =
    "write the number without a separator between its thousands, with a decimal point: 1008.5";

/// Returns whether a mark in a number stands where it would separate thousands: `1,008`, `1,008,000`, but not `0,996`.
fn grouped(cell: &str, mark: char) -> bool {
    let digits = cell.trim_start_matches(['+', '-', ' ']);
    let whole = if mark == ',' {
        digits.split('.').next().unwrap_or(digits)
    } else {
        digits.split(',').next().unwrap_or(digits)
    };
    let mut groups = whole.split(mark);
    let is_plain = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    let mut is_grouped = false;
    (1..=3).contains(&first.len())
        && is_plain(first)
        && !first.starts_with('0')
        && groups.all(|group| {
            is_grouped = true;
            group.len() == 3 && is_plain(group)
        })
        && is_grouped
}

/// Returns the greatest step between neighbouring values, as a share of their range.
fn jump(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(*value), high.max(*value))
        });
    steps.fold(0.0, f64::max) / (high - low)
}

/// Returns the numbers of the named column of a table.
///
/// # Errors
/// A table without the column or without rows, and what [`Table::numbers`] refuses.
pub fn column(file: &str, text: &str, name: &str) -> Result<Vec<f64>, Problem> {
    let table = Table::parse(text, &[name]);
    let problem = |line, found: &str, allowed: &str, remedy: &str| Problem {
        file: file.to_owned(),
        line,
        found: found.to_owned(),
        allowed: allowed.to_owned(),
        remedy: remedy.to_owned(),
    };
    if table.names.is_empty() {
        let remedy = "check that the program has finished writing the file";
        return Err(problem(None, "nothing", "a table with a header", remedy));
    }
    let Some(at) = table.column(name) else {
        let found = format!("columns {}", clip(&table.names.join(", ")));
        let allowed = format!("a table with a column `{name}`");
        let remedy = "correct the column's name in the case";
        return Err(problem(Some(1), &found, &allowed, remedy));
    };
    if table.is_empty() {
        let remedy = "check the program's results file";
        let found = "a header alone";
        return Err(problem(Some(1), found, "a table with rows", remedy));
    }
    let rows: Vec<usize> = (0..table.len()).collect();
    table.numbers(at, &rows).map_err(|cell| {
        let remedy = format!("check the program's results file: {}", cell.remedy);
        problem(Some(cell.line), &cell.found, &cell.allowed, &remedy)
    })
}

#[cfg(test)]
mod tests {
    use super::{Table, column};

    #[test]
    fn columns_are_found_between_commas_semicolons_and_blanks() {
        for text in [
            "# time,force\n0,1\n1,2.5\n",
            "time; force\n0; 1\n\n1; 2.5",
            "time; force\n0,0; 1,0\n1,0;2,5",
            "\u{feff}\"time\"  \"force\"\n 0  1 \n 1\t2.5D0\n",
            "Logger,X1\nmade by,somebody\n\n1,time,force\nNO.,s,N\n\n 1,0,+ 1\n 2,1,+    2.5\n",
            "time\tforce\r\n[s]\t[N]\r\n0\t1\r\n\t\r\n1\t2,5\r\n",
        ] {
            assert_eq!(column("f", text, "force").unwrap(), [1.0, 2.5], "{text}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_named_by_line() {
        for (text, words) in [
            ("", "nothing"),
            ("a,b\n", "header alone"),
            ("a,c\n1,2\n", "column `b`"),
            ("a,b\n1,2\n3\n", "line 3"),
            ("a,b\n\n\r\n1,2\n\n3\n", "line 6"),
            ("a,b\n1,NaN\n2,3\n", "line 2: `NaN`"),
            ("made by x\na;b\n\n1;2\n\n3;x\n", "line 6: `x`"),
            ("a,b\n1,2,3\n", "3 cells"),
        ] {
            let error = column("f", text, "b").unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }

    /// Checks that separated thousands are never read as decimals, and that decimals never pass for thousands.
    #[test]
    fn thousands_are_told_from_decimals() {
        for text in [
            "t\tb\n0.1\t984\n0.2\t996\n0.3\t1,008\n0.4\t1,020\n",
            "t;b\n0.1;1,008\n0.2;1,020\n",
            "t;b\n1;984\n2;996\n3;1,008\n4;1,020\n",
            "t;b\n1;984\n2;996\n3;1.008\n4;1.020\n",
            "t;b\n1;1,008,000\n",
            "t;b\n1;1,008.5\n",
            "t;b\n1;1.008,5\n",
            "t,b\n1,\"1,008\"\n",
        ] {
            let error = column("f", text, "b").unwrap_err().to_string();
            assert!(error.contains("thousands"), "{text:?}: {error}");
        }
        for (text, values) in [
            ("t;b\n1;0,996\n2;1,008\n", [0.996, 1.008]),
            ("t;b\n1;1,008\n2;1,020\n", [1.008, 1.02]),
            ("t;b\n1;100\n2;100,125\n", [100.0, 100.125]),
            ("t,b\n1,100\n2,100.125\n", [100.0, 100.125]),
            ("t,b\n1,1.008\n2,1.020\n", [1.008, 1.02]),
            ("t;b\n0.5;1,08\n1;2\n", [1.08, 2.0]),
        ] {
            assert_eq!(column("f", text, "b").unwrap(), values, "{text:?}");
        }
    }

    #[test]
    fn rows_are_counted_as_lines_of_the_file() {
        let table = Table::parse("\n# x,y\n\n1,2\n\r\n\r\n3,4\n,\n5,6", &["x"]);
        let lines: Vec<usize> = (0..table.len()).map(|row| table.line(row)).collect();
        assert_eq!(lines, [4, 7, 9]);
        assert_eq!(table.numbers(1, &[2]).unwrap(), [6.0]);
    }
}
