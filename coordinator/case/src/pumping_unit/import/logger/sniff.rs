//! Proposal of the layout of a table from the content of its file.
use super::{
    layout::{Cells, Delimiter, Layout, is_comment, means_missing},
    lines::Lines,
    unit::normal,
};
use crate::error::{CaseError, damaged};
use exchange::utf8_or_latin1;
use std::{collections::VecDeque, path::Path};

/// First and last lines of a file, from which its layout is proposed.
#[derive(Debug)]
pub(crate) struct Sample {
    /// First lines with their numbers.
    pub(crate) head: Vec<(u64, Vec<u8>)>,
    /// Last lines with their numbers; they may overlap with the first ones.
    tail: VecDeque<(u64, Vec<u8>)>,
    /// Number of lines of the file.
    pub(crate) lines: u64,
}

/// Number of lines that are looked at from the start of a file: preambles have dozens.
const HEAD: usize = 600;

/// Number of lines that are looked at at the end of a file.
const TAIL: usize = 40;

/// Number of rows from whose cells the columns of the time are recognised.
const ROWS: usize = 100;

/// Smallest number of lines in succession that are a table.
const FEWEST: usize = 4;

impl Sample {
    /// Reads the first and the last lines of a file.
    ///
    /// # Errors
    /// Returns an error for a file that cannot be read or is empty.
    pub(crate) fn read(path: &Path) -> Result<Self, CaseError> {
        let mut lines = Lines::open(path)?;
        let mut sample = Self {
            head: Vec::new(),
            tail: VecDeque::new(),
            lines: 0,
        };
        while let Some((number, line)) = lines.next()? {
            if sample.head.len() < HEAD {
                sample.head.push((number, line.to_owned()));
            }
            if sample.tail.len() == TAIL {
                sample.tail.pop_front();
            }
            sample.tail.push_back((number, line.to_owned()));
            sample.lines = number;
        }
        if sample.head.iter().all(|(_, line)| is_comment(line)) {
            return Err(damaged(
                path,
                "the file is empty",
                "copy it again from its source",
            ));
        }
        Ok(sample)
    }

    /// Returns the cells of rows at the start and the end of the data.
    pub(crate) fn rows(&self, layout: &Layout) -> Vec<Vec<String>> {
        let mut cells = Cells::default();
        let head = self
            .head
            .iter()
            .filter(|(number, _)| *number >= layout.first_line);
        let data = usize::try_from(layout.footer_lines).unwrap_or(TAIL);
        let tail = self.tail.iter().take(self.tail.len().saturating_sub(data));
        let tail = tail.filter(|(number, _)| *number >= layout.first_line);
        let lines = head.take(ROWS).chain(tail);
        let lines = lines.filter(|(_, line)| !is_comment(line));
        lines
            .map(|(_, line)| {
                layout.delimiter.split(line, &mut cells);
                cells
                    .iter()
                    .map(|cell| utf8_or_latin1(cell).into_owned())
                    .collect()
            })
            .collect()
    }

    /// Returns a line of the start of the file.
    pub(super) fn line(&self, number: u64) -> Option<&[u8]> {
        let found = self.head.iter().find(|(own, _)| *own == number);
        found.map(|(_, line)| line.as_slice())
    }
}

/// Proposes the layout of a table: the delimiter under which the most lines in succession are rows of the
/// same number of cells, most of which are numbers or times.
///
/// # Errors
/// Returns an error for a file in which no table is found.
pub(crate) fn sniff(path: &Path, sample: &Sample) -> Result<Layout, CaseError> {
    let blocks = Delimiter::ALL.map(|delimiter| (delimiter, block(sample, delimiter)));
    let best = blocks.iter().max_by_key(|(delimiter, (rows, _))| {
        let place = Delimiter::ALL.iter().position(|own| own == delimiter);
        (rows.len(), std::cmp::Reverse(place))
    });
    let Some((delimiter, (rows, width))) = best.filter(|(_, (rows, _))| rows.len() >= FEWEST)
    else {
        return Err(damaged(
            path,
            format!(
                "no table was found in it: no {FEWEST} lines in succession have the same number of cells, \
                 two or more, most of them numbers"
            ),
            "export the measurement as text (CSV), with one line per sample",
        ));
    };
    let (delimiter, width) = (*delimiter, *width);
    let first = rows.first().copied().unwrap_or_default();
    let cells = numbers(sample, rows, delimiter);
    let (decimal, thousands) = decimal(&cells, delimiter);
    let mut layout = Layout {
        delimiter,
        decimal,
        thousands,
        header_line: None,
        units_line: None,
        first_line: first,
        footer_lines: 0,
        missing: Vec::new(),
    };
    header(sample, &mut layout, width);
    layout.footer_lines = footer(sample, delimiter);
    Ok(layout)
}

/// Returns the numbers of the lines of the longest table under a delimiter, and the number of its cells.
fn block(sample: &Sample, delimiter: Delimiter) -> (Vec<u64>, usize) {
    let (mut best, mut widest) = (Vec::new(), 0);
    let (mut rows, mut width) = (Vec::new(), 0);
    let mut cells = Cells::default();
    for (number, line) in &sample.head {
        if is_comment(line) {
            continue;
        }
        delimiter.split(line, &mut cells);
        let filled = cells.filled();
        let row = is_row(&cells);
        // the last cells of a row may be empty
        if !row || filled > cells.len() || (!rows.is_empty() && cells.len() != width) {
            rows.clear();
        }
        if row {
            width = cells.len();
            rows.push(*number);
            if rows.len() > best.len() {
                best.clone_from(&rows);
                widest = width;
            }
        }
    }
    (best, widest)
}

/// Returns whether a line is a row of data: two cells or more, more than half of the filled ones numbers,
/// times or words for missing values.
fn is_row(cells: &Cells) -> bool {
    let filled = cells.iter().filter(|cell| !cell.is_empty());
    let values = cells.iter().filter(|cell| is_value(cell)).count();
    let words = cells.iter().filter(|cell| is_word(cell)).count();
    cells.len() >= 2 && values >= 1 && 2 * (values + words) > filled.count()
}

/// Returns whether a cell looks like a number or a time: digits with signs between them.
fn is_value(cell: &[u8]) -> bool {
    let (Some(first), Some(last)) = (cell.first(), cell.last()) else {
        return false;
    };
    let of_time = cell.contains(&b':');
    let signed = matches!(first, b'+' | b'-');
    let blank = |byte: &u8| matches!(byte, b' ' | 0xc2 | 0xa0);
    let inner = |(index, byte): (usize, &u8)| match byte {
        b'0'..=b'9' | b'.' | b',' | b'-' | b'/' | b':' | b'+' | b'e' | b'E' | b'\'' => true,
        b'T' | b'Z' | b'A' | b'P' | b'M' | b'a' | b'p' | b'm' => of_time,
        // `+    2.00`, `1 008,5`, `1.5.2024 12:00:00`
        _ if blank(byte) => {
            let rest = &cell[index..];
            of_time || signed || rest.iter().filter(|byte| !blank(byte)).count() >= 3
        }
        _ => false,
    };
    (first.is_ascii_digit() || matches!(first, b'+' | b'-' | b'.'))
        && (last.is_ascii_digit() || *last == b'.' || of_time)
        && cell.iter().any(u8::is_ascii_digit)
        && cell.iter().enumerate().all(inner)
}

/// Returns whether a cell is a known word for a missing value.
fn is_word(cell: &[u8]) -> bool {
    means_missing(&utf8_or_latin1(cell))
}

/// Returns the cells of a table that look like numbers.
fn numbers(sample: &Sample, rows: &[u64], delimiter: Delimiter) -> Vec<Vec<String>> {
    let mut columns: Vec<Vec<String>> = Vec::new();
    let mut cells = Cells::default();
    for line in rows.iter().filter_map(|number| sample.line(*number)) {
        delimiter.split(line, &mut cells);
        columns.resize_with(columns.len().max(cells.len()), Vec::new);
        for (column, cell) in columns.iter_mut().zip(cells.iter()) {
            let time = cell.contains(&b':') || utf8_or_latin1(cell).matches('.').count() > 1;
            if is_value(cell) && !time && !cell.contains(&b'/') {
                column.push(utf8_or_latin1(cell).into_owned());
            }
        }
    }
    columns
}

/// Returns the decimal sign of numbers, and their separator of thousands.
fn decimal(columns: &[Vec<String>], delimiter: Delimiter) -> (char, Option<char>) {
    let all = || columns.iter().flatten();
    let both = all().find(|cell| cell.contains(',') && cell.contains('.'));
    if let Some(both) = both {
        let comma_last = both.rfind(',') > both.rfind('.');
        return if comma_last {
            (',', Some('.'))
        } else {
            ('.', Some(','))
        };
    }
    if !all().any(|cell| cell.contains(',')) {
        return ('.', None);
    }
    // `1,008` after `996`: every comma has three digits after it, and no number of four digits lacks one
    let groups = |cell: &String| {
        let digits = cell.trim_start_matches(['+', '-']);
        let mut parts = digits.split(',');
        let first = parts.next().unwrap_or_default();
        let rest: Vec<&str> = parts.collect();
        (1..=3).contains(&first.len())
            && (rest.is_empty() || !first.starts_with('0'))
            && rest.iter().all(|part| part.len() == 3)
    };
    let with_comma = || {
        columns
            .iter()
            .filter(|column| column.iter().any(|cell| cell.contains(',')))
    };
    let whole = |column: &Vec<String>| {
        column.iter().all(groups) && column.iter().any(|cell| !cell.contains(','))
    };
    if with_comma().all(whole) || (delimiter == Delimiter::Comma && all().all(groups)) {
        ('.', Some(','))
    } else if all().any(|cell| cell.contains('.')) {
        // columns that disagree: the cells of the others are listed as no numbers
        ('.', None)
    } else {
        (',', None)
    }
}

/// Finds the lines of names and of units above the data.
fn header(sample: &Sample, layout: &mut Layout, width: usize) {
    let mut cells = Cells::default();
    let delimiter = layout.delimiter;
    let above: Vec<&(u64, Vec<u8>)> = {
        let before = sample.head.iter();
        let before = before.take_while(|(number, _)| *number < layout.first_line);
        let filled = before.filter(|(_, line)| !line.trim_ascii().is_empty());
        filled.collect()
    };
    let mut last = above.iter().rev().filter(|(_, line)| {
        // the name of a section between header and data is neither
        let mut cells = Cells::default();
        delimiter.split(line, &mut cells);
        !is_comment(line) || 2 * cells.filled() > width
    });
    let mut next = || last.next().map(|(number, line)| (*number, line.as_slice()));
    let Some((number, line)) = next() else { return };
    layout.delimiter.split(line, &mut cells);
    let enough = |cells: &Cells| 2 * cells.filled() > width;
    let values = |cells: &Cells| cells.iter().filter(|cell| is_value(cell)).count();
    if !enough(&cells) || 2 * values(&cells) > cells.filled() {
        return;
    }
    let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
    let units = cells
        .iter()
        .filter(|cell| normal(&utf8_or_latin1(cell)).is_some());
    let units = units.count();
    // names with blanks in them cannot be told apart where blanks separate the cells
    if delimiter == Delimiter::Blanks && cells.len() != width {
        return;
    }
    if 3 * units >= filled
        && let Some((names, line)) = next()
    {
        layout.delimiter.split(line, &mut cells);
        if enough(&cells) && values(&cells) == 0 {
            layout.units_line = Some(number);
            layout.header_line = Some(names);
            return;
        }
    }
    layout.header_line = Some(number);
}

/// Returns the number of lines after the data, without empty ones and comments.
fn footer(sample: &Sample, delimiter: Delimiter) -> u64 {
    let mut cells = Cells::default();
    let lines = sample
        .tail
        .iter()
        .rev()
        .filter(|(_, line)| !is_comment(line));
    let footer = lines.take_while(|(_, line)| {
        delimiter.split(line, &mut cells);
        !is_row(&cells) && !cells.get(0).is_some_and(is_value)
    });
    footer.count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(content: &[u8]) -> Layout {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), content).unwrap();
        sniff(file.path(), &Sample::read(file.path()).unwrap()).unwrap()
    }

    /// Checks the layout of tables as loggers, amplifiers and spreadsheets write them.
    #[test]
    fn layouts_of_loggers_are_recognised() {
        type Expected = (
            Delimiter,
            char,
            Option<char>,
            Option<u64>,
            Option<u64>,
            u64,
            u64,
        );
        let cases: [(&[u8], Expected); 8] = [
            (
                b"Vendor,GRAPHTEC\nModel,GL240\nSampling,100ms\nNo.,Date&Time,ms,CH1,CH2,A1\n\
                  NO.,Time,ms,V,V,A123\n1,2024/05/01 12:00:00,0,+    2.00,+ 1.0,LLLL\n\
                  2,2024/05/01 12:00:00,100,+    2.01,- 1.0,LLLL\n\
                  3,2024/05/01 12:00:00,200,+    2.01,- 1.0,LLLL\n\
                  4,2024/05/01 12:00:00,300,+    2.02,- 1.0,LLLL\n",
                (Delimiter::Comma, '.', None, Some(4), Some(5), 6, 0),
            ),
            (
                b"Messung 1\n\nZeit [s];DMS1 [\xb5m/m];DMS2 [\xb5m/m]\n0,00;-154;91\n0,01;-155;NaN\n\
                  0,02;-155,5;92\n0,03;-156;93\nEnde der Datei\n",
                (Delimiter::Semicolon, ',', None, Some(3), None, 4, 1),
            ),
            (
                b"\xef\xbb\xbft\ta\tb\n0.0\t1.0\t2.0\n0.1\t1.0\t2.0\n0.2\t1.0\t2.0\n0.3\t1.0\t2.0\n",
                (Delimiter::Tab, '.', None, Some(1), None, 2, 0),
            ),
            (
                b"0.0  1.0 2.0\n0.1  1.0 2.0\n0.2  1.0 2.0\n0.3  1.0 2.0\n",
                (Delimiter::Blanks, '.', None, None, None, 1, 0),
            ),
            (
                b"time;load\n0;996\n1;1,008\n2;1,020\n3;1,032\n",
                (Delimiter::Semicolon, '.', Some(','), Some(1), None, 2, 0),
            ),
            (
                b"time;load\n0;1.008,25\n1;996,25\n2;984\n3;1.032,1\n",
                (Delimiter::Semicolon, ',', Some('.'), Some(1), None, 2, 0),
            ),
            (
                b"time,load\n0,\"1,008.5\"\n1,996.5\n2,984\n3,\"1,032\"\n",
                (Delimiter::Comma, '.', Some(','), Some(1), None, 2, 0),
            ),
            (
                b"# well 7\n# position, length, weight\n0,0.0,5000\n2,0.1,5100\n# top\n4,0.2,5200\n6,0.3,5300\n8,0.4\n",
                (Delimiter::Comma, '.', None, Some(2), None, 3, 0),
            ),
        ];
        for (content, expected) in cases {
            let found = layout(content);
            let found = (
                found.delimiter,
                found.decimal,
                found.thousands,
                found.header_line,
                found.units_line,
                found.first_line,
                found.footer_lines,
            );
            assert_eq!(found, expected, "{}", utf8_or_latin1(content));
        }
    }

    #[test]
    fn a_letter_is_not_a_table() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "Dear colleague,\nthe files follow.\n").unwrap();
        let sample = Sample::read(file.path()).unwrap();
        let error = sniff(file.path(), &sample).unwrap_err().to_string();
        assert!(error.contains("no table was found"), "{error}");
    }
}
