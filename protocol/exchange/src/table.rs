//! Reading of tables with a header: records of loggers and results of programs.
use crate::{Problem, number, problem::clip};
use std::{borrow::Cow, ops::Range};

/// Number of lines among which the header is searched for.
const PREAMBLE: usize = 200;

/// Table of text cells under a header.
///
/// Columns stand between commas, semicolons, tabs or blanks; a cell in double quotes may contain them. The header is the first
/// line that contains all needed names, optionally after a `#` or `%`, above a row of the same length with numbers in the
/// needed columns; lines before it are a preamble of the program that wrote the table. A row of units below the header is left
/// out, as are empty rows.
#[derive(Clone, Debug)]
pub struct TextTable {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Rows of the table, in the order of the file.
    rows: Vec<Row>,
    /// Texts of all cells one after the other: a record of some hours has a hundred million.
    text: String,
    /// End of each cell in the text.
    ends: Vec<usize>,
    /// Indices of the needed columns that the table has.
    needed: Vec<usize>,
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
    Character(char),
    Blanks,
}

impl Separator {
    const ALL: [Self; 4] = [
        Self::Character(','),
        Self::Character(';'),
        Self::Character('\t'),
        Self::Blanks,
    ];

    fn is_in(self, line: &str) -> bool {
        match self {
            Self::Character(character) => line.contains(character),
            Self::Blanks => true,
        }
    }

    /// Calls a function for every cell of a line, without the blanks and quotes about it.
    fn each_cell(self, line: &str, mut cell: impl FnMut(&str)) {
        match self {
            Self::Character(character) if !line.contains('"') => {
                line.split(character).for_each(|text| cell(text.trim()));
            }
            Self::Blanks if !line.contains('"') => line.split_whitespace().for_each(cell),
            Self::Character(_) | Self::Blanks => {
                let (byte, line) = match self {
                    Self::Character(character) => (character, Cow::Borrowed(line)),
                    Self::Blanks => (' ', Cow::Owned(line.replace('\t', " "))),
                };
                let mut reader = csv::ReaderBuilder::new()
                    .has_headers(false)
                    .delimiter(u8::try_from(byte).unwrap_or(b','))
                    .trim(csv::Trim::All)
                    .from_reader(line.as_bytes());
                // text in memory can neither fail to be read nor be anything but UTF-8
                let record = reader.records().next().and_then(Result::ok);
                let cells = record.unwrap_or_default();
                let filled = cells.iter().map(|text| text.trim_matches('"').trim());
                let is_kept = |text: &&str| self != Self::Blanks || !text.is_empty();
                filled.filter(is_kept).for_each(cell);
            }
        }
    }

    fn names(self, line: &str) -> Vec<String> {
        let line = line.trim_start_matches(['#', '%', ' ', '\t']);
        let mut names = Vec::new();
        self.each_cell(line.trim_end(), |cell| names.push(cell.to_owned()));
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        names
    }

    /// Parses a cell as a finite number. A decimal comma is accepted where commas do not separate cells, and blanks behind
    /// a sign.
    fn number(self, cell: &str) -> Option<f64> {
        let signed = cell.strip_prefix(['+', '-']).and_then(|rest| {
            let sign = cell.get(..1)?;
            rest.starts_with(' ')
                .then(|| format!("{sign}{}", rest.trim_start()))
        });
        let plain = signed.as_deref().unwrap_or(cell);
        if self == Self::Character(',') || !plain.contains(',') {
            return number(plain);
        }
        number(&plain.replacen(',', ".", 1))
    }
}

/// Header of a table: index of its line, separator and names.
type Header = (usize, Separator, Vec<String>);

/// Finds the header; without a line that holds all needed names it is the first line that is not empty.
fn header(text: &str, needed: &[&str]) -> Option<Header> {
    let lines = || {
        let lines = text.lines().enumerate();
        lines.filter(|(_, line)| !line.trim().is_empty())
    };
    let candidate = |(at, line): (usize, &str)| -> Option<Header> {
        let present = Separator::ALL.into_iter().filter(|it| it.is_in(line));
        let named = present.map(|separator| (at, separator, separator.names(line)));
        let has_all = |names: &[String]| needed.iter().all(|name| names.iter().any(|n| n == name));
        named.into_iter().find(|(_, _, names)| has_all(names))
    };
    // whether a line has the form of the rows below a header
    let is_row = |(_, separator, names): &Header, line: &str| {
        let mut cells = Vec::new();
        separator.each_cell(line, |cell| cells.push(cell.to_owned()));
        let filled = cells.iter().rposition(|cell| !cell.is_empty());
        let is_number = |name: &&str| {
            let at = names.iter().position(|own| own == name);
            let cell = at.and_then(|at| cells.get(at));
            cell.is_some_and(|cell| separator.number(cell).is_some())
        };
        cells.len() >= names.len()
            && filled.is_some_and(|last| last < names.len())
            && needed.iter().all(is_number)
    };
    let mut first: Option<Header> = None;
    for (at, line) in lines().take(PREAMBLE) {
        let Some(found) = candidate((at, line)) else {
            continue;
        };
        let mut below = lines().skip_while(|(line, _)| *line <= at);
        let (next, after) = (below.next(), below.next());
        let is_title = next.is_some_and(|next| candidate(next).is_some()) && !needed.is_empty();
        let mut rows = next.into_iter().chain(after.filter(|_| !is_title));
        // without names to go by, the first line that is no comment
        let is_first = needed.is_empty() && !line.trim_start().starts_with(['#', '%']);
        if is_first || rows.any(|(_, line)| is_row(&found, line)) {
            return Some(found);
        }
        // where no candidate stands above numbers, the first that is no title has to say so
        if first.is_none() && !is_title {
            first = Some(found);
        }
    }
    first.or_else(|| {
        let (at, line) = lines().next()?;
        let separator = Separator::ALL.into_iter().find(|it| it.is_in(line))?;
        Some((at, separator, separator.names(line)))
    })
}

impl TextTable {
    /// Splits a text into a table; `needed` are names that the header must contain. Without a line that contains them the
    /// first line that is not empty is the header.
    pub fn parse(text: &str, needed: &[&str]) -> Self {
        let text = text.trim_start_matches('\u{feff}');
        // line ends of old Macintosh programs
        let text = if text.contains('\r') && !text.contains('\n') {
            Cow::Owned(text.replace('\r', "\n"))
        } else {
            Cow::Borrowed(text)
        };
        let mut table = Self {
            names: Vec::new(),
            rows: Vec::new(),
            text: String::new(),
            ends: Vec::new(),
            needed: Vec::new(),
            separator: Separator::Blanks,
        };
        let Some((at, separator, names)) = header(&text, needed) else {
            return table;
        };
        (table.separator, table.names) = (separator, names);
        table.needed = needed
            .iter()
            .filter_map(|name| table.column(name))
            .collect();
        for (index, line) in text.lines().enumerate().skip(at + 1) {
            let (first, empty) = (table.ends.len(), table.text.len());
            separator.each_cell(line, |cell| {
                table.text.push_str(cell);
                table.ends.push(table.text.len());
            });
            if table.text.len() == empty {
                table.ends.truncate(first);
                continue;
            }
            // separators behind the last column
            let ends = |at: usize| table.ends.get(at).copied();
            let mut length = table.ends.len();
            while length > first + table.names.len() && ends(length - 2) == ends(length - 1) {
                length -= 1;
            }
            table.ends.truncate(length);
            table.rows.push(Row {
                line: index + 1,
                cells: first..length,
            });
        }
        if table.has_units() {
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
    pub fn width(&self, row: usize) -> usize {
        self.rows.get(row).map_or(0, |row| row.cells.len())
    }

    /// Returns whether blanks separate the cells, so that a row cannot have an empty one.
    pub fn is_blank_separated(&self) -> bool {
        self.separator == Separator::Blanks
    }

    /// Returns whether the first row holds the units of the needed columns: words in all of them, above numbers.
    fn has_units(&self) -> bool {
        /// Parts of words that loggers and programs write in place of a lost value: `-nan`, `1.#QNAN`, `***`, `N/A`.
        const LOST: [&str; 11] = [
            "nan", "inf", "n/a", "null", "none", "#", "*", "err", "over", "bad", "--",
        ];
        let is_word = |column: &usize| {
            let cell = self.cell(0, *column).to_lowercase();
            let is_lost = cell == "na" || LOST.iter().any(|part| cell.contains(part));
            let plain = cell.trim_start_matches(['+', '-', '.', ' ']);
            let is_numeric = plain.starts_with(|letter: char| letter.is_ascii_digit());
            !cell.is_empty() && !is_lost && !is_numeric
        };
        let is_number = |column: &usize| {
            let cell = self.cell(1, *column);
            self.separator.number(cell).is_some()
        };
        let mut columns = 0..self.names.len();
        !self.needed.is_empty()
            && self.rows.len() > 1
            && self.width(0) == self.names.len()
            && columns.all(|column| self.separator.number(self.cell(0, column)).is_none())
            && self.needed.iter().all(is_word)
            && self.needed.iter().all(is_number)
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
                let remedy = if self.separator == Separator::Character(',')
                    && length > self.names.len()
                {
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
            let value = self.separator.number(cell).ok_or_else(|| {
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
            Some(row) if self.separates_thousands(column, rows) => Err(wrong(
                row,
                quoted(row),
                "a number without separated thousands",
                THOUSANDS,
            )),
            _ => Ok(values),
        }
    }

    /// Returns whether commas or points in a column separate thousands: all numbers that have one look like that, and the needed
    /// columns have the other mark for their decimals. A comma also separates thousands if whole numbers stand beside such
    /// numbers: a program that writes decimals with a comma writes `0,000`.
    fn separates_thousands(&self, column: usize, rows: &[usize]) -> bool {
        [(',', '.'), ('.', ',')].into_iter().any(|(mark, other)| {
            let cells = || rows.iter().map(|row| self.cell(*row, column));
            let marked = || cells().filter(move |cell| cell.contains(mark));
            if marked().next().is_none() || !marked().all(|cell| grouped(cell, mark)) {
                return false;
            }
            let is_decimal = |cell: &str| {
                let has_other = cell.contains(other) && !cell.contains(mark);
                has_other && self.separator.number(cell).is_some()
            };
            let mut columns = self.needed.iter();
            (mark == ',' && cells().any(|cell| !cell.contains(mark)))
                || columns.any(|at| rows.iter().any(|row| is_decimal(self.cell(*row, *at))))
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

/// Returns the numbers of the named columns of a table, in the order of the names.
///
/// # Errors
/// A table without the columns, with one of them twice or without rows, and what [`TextTable::numbers`] refuses.
pub fn columns(file: &str, text: &str, names: &[&str]) -> Result<Vec<Vec<f64>>, Problem> {
    let table = TextTable::parse(text, names);
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
    let rows: Vec<usize> = (0..table.len()).collect();
    let column = |name: &&str| {
        let found = format!("columns {}", clip(&table.names.join(", ")));
        let allowed = format!("a table with a column `{name}`");
        match table.names.iter().filter(|own| own == name).count() {
            0 => {
                let remedy = "correct the column's name in the case";
                return Err(problem(None, &found, &allowed, remedy));
            }
            1 => {}
            _ => {
                let remedy = "check the program's results file: give its columns different names";
                let allowed = format!("a table with one column `{name}`");
                return Err(problem(None, &found, &allowed, remedy));
            }
        }
        if rows.is_empty() {
            let remedy = "check the program's results file";
            let found = "a header alone";
            return Err(problem(Some(1), found, "a table with rows", remedy));
        }
        let at = table.column(name).unwrap_or_default();
        table.numbers(at, &rows).map_err(|cell| {
            let remedy = format!("check the program's results file: {}", cell.remedy);
            problem(Some(cell.line), &cell.found, &cell.allowed, &remedy)
        })
    };
    names.iter().map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::{TextTable, columns};
    use crate::Problem;

    fn column(text: &str, name: &str) -> Result<Vec<f64>, Problem> {
        columns("f", text, &[name]).map(|all| all.concat())
    }

    #[test]
    fn columns_are_found_between_commas_semicolons_and_blanks() {
        for text in [
            "# time,force\n0,1\n1,2.5\n",
            "time; force\n0; 1\n\n1; 2.5",
            "time; force\n0,0; 1,0\n1,0;2,5",
            "\u{feff}\"time\"  \"force\"\n 0  1 \n 1\t2.5D0\n",
            "\"time (s)\"  \"force\"\n 0  1 \n 1\t2.5\n",
            "Logger,X1\nmade by,somebody\n\n1,time,force\nNO.,s,N\n\n 1,0,+ 1\n 2,1,+    2.5\n",
            "time\tforce\r\n[s]\t[N]\r\n0\t1\r\n\t\r\n1\t2,5\r\n",
            "time,force,\n0,1,\n1,2.5,\n",
            "time,force\r0,1\r1,2.5\r",
            "% time force\n0 1\n1 2.5\n",
            "time,force,note\n0,1,\"a, b\"\n1,2.5,\"5 in\n",
        ] {
            assert_eq!(column(text, "force").unwrap(), [1.0, 2.5], "{text}");
        }
    }

    /// Checks that a title with the names of columns is not taken for the header.
    #[test]
    fn the_header_stands_above_numbers() {
        for text in [
            "y, kPa\nt,y\n0,10\n1,20\n",
            "y curve\nt y\n0 10\n1 20\n",
            "y over t\nt y\n0 10\n1 20\n",
            "y,t\nt,y\n0,10\n1,20\n",
            "# comment with t and y\nt,y\n0,10\n1,20\n",
            "y at support\nt x y\n0 1 10\n1 2 20\n",
        ] {
            let read = columns("f", text, &["t", "y"]).unwrap();
            assert_eq!(read, [[0.0, 1.0], [10.0, 20.0]], "{text}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_named_by_line() {
        for (text, words) in [
            ("", "nothing"),
            ("a,b\n", "header alone"),
            ("a,c\n1,2\n", "column `b`"),
            ("a,b,b\n1,2,3\n", "one column `b`"),
            ("a,b\n1,2\n3\n", "line 3"),
            ("a,b\n\n\r\n1,2\n\n3\n", "line 6"),
            ("a,b\n1,NaN\n2,3\n", "line 2: `NaN`"),
            ("a,b\n1,-1.#IND\n2,3\n", "line 2: `-1.#IND`"),
            ("a,b\n1,1-2\n2,3\n", "`1-2`"),
            ("a,b\n1,OL\n2,3\n", "`OL`"),
            ("made by x\na;b\n\n1;2\n\n3;x\n", "line 6: `x`"),
            ("a,b\n1,2,3\n", "3 cells"),
        ] {
            let error = column(text, "b").unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }

    /// Checks that separated thousands are never read as decimals, and that decimals never pass for thousands.
    #[test]
    fn thousands_are_told_from_decimals() {
        for text in [
            "t\tb\n0.1\t984\n0.2\t996\n0.3\t1,008\n0.4\t1,020\n",
            "t;b\n1;984\n2;996\n3;1,008\n4;1,020\n",
            "t;b\n0;0\n1;1,200\n2;2,400\n",
            "t;b\n0,5;1,250\n1,5;980\n2,5;1,500\n",
            "t;b\n1;1,008,000\n",
            "t;b\n1;1,008.5\n",
            "t;b\n1;1.008,5\n",
            "t,b\n1,\"1,008\"\n",
        ] {
            let error = column(text, "b").unwrap_err().to_string();
            assert!(error.contains("thousands"), "{text:?}: {error}");
        }
        for text in ["t;b\n0.1;1,008\n0.2;1,020\n", "t;b\n0,1;996\n0,2;1.008\n"] {
            let error = columns("f", text, &["t", "b"]).unwrap_err().to_string();
            assert!(error.contains("thousands"), "{error}");
        }
        for (text, values) in [
            ("t;b\n1;0,996\n2;1,008\n", [0.996, 1.008]),
            ("t;b\n1;1,008\n2;1,020\n", [1.008, 1.02]),
            ("t;b;id\n1;1,008;2.1\n2;1,020;2.1\n", [1.008, 1.02]),
            ("t,b\n1,100\n2,100.125\n", [100.0, 100.125]),
            ("t b\n1 300\n2 1.025\n", [300.0, 1.025]),
            ("t,b\n1,1.008\n2,1.020\n", [1.008, 1.02]),
            ("t;b\n0.5;1,08\n1;2\n", [1.08, 2.0]),
        ] {
            assert_eq!(column(text, "b").unwrap(), values, "{text:?}");
        }
    }

    #[test]
    fn rows_are_counted_as_lines_of_the_file() {
        let table = TextTable::parse("\n# x,y\n\n1,2\n\r\n\r\n3,4\n,\n5,6", &["x"]);
        let lines: Vec<usize> = (0..table.len()).map(|row| table.line(row)).collect();
        assert_eq!(lines, [4, 7, 9]);
        assert_eq!(table.numbers(1, &[2]).unwrap(), [6.0]);
    }
}
