//! Layout of a table in a text file: separators, and the lines that are not data.
use exchange::utf8_or_latin1;
use serde::{Deserialize, Serialize};

/// Separator of the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub(crate) enum Delimiter {
    /// Tabulator.
    #[serde(rename = "tab")]
    Tab,
    /// Semicolon.
    #[serde(rename = ";")]
    Semicolon,
    /// Comma.
    #[serde(rename = ",")]
    Comma,
    /// Vertical bar.
    #[serde(rename = "|")]
    Bar,
    /// Any number of blanks and tabulators.
    #[serde(rename = "blanks")]
    Blanks,
}

impl Delimiter {
    /// All delimiters; of those under which a table reads equally well the first is meant.
    pub(super) const ALL: [Self; 5] = [
        Self::Tab,
        Self::Semicolon,
        Self::Comma,
        Self::Bar,
        Self::Blanks,
    ];

    const fn byte(self) -> u8 {
        match self {
            Self::Tab => b'\t',
            Self::Semicolon => b';',
            Self::Comma => b',',
            Self::Bar => b'|',
            Self::Blanks => b' ',
        }
    }

    /// Splits a line into cells without surrounding blanks and quotes.
    pub(super) fn split(self, line: &[u8], cells: &mut Cells) {
        cells.text.clear();
        cells.ends.clear();
        if self == Self::Blanks {
            let filled = line.split(u8::is_ascii_whitespace);
            filled
                .filter(|cell| !cell.is_empty())
                .for_each(|cell| cells.push(cell));
        } else if line.contains(&b'"') {
            let mut reader = csv::ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .delimiter(self.byte())
                .from_reader(line);
            let mut record = csv::ByteRecord::new();
            // the line is in memory, and any bytes are a record
            if reader.read_byte_record(&mut record).unwrap_or_default() {
                record.iter().for_each(|cell| cells.push(cell));
            }
        } else {
            line.split(|byte| *byte == self.byte())
                .for_each(|cell| cells.push(cell));
        }
    }
}

/// Cells of one line.
#[derive(Debug, Default)]
pub(super) struct Cells {
    text: Vec<u8>,
    ends: Vec<usize>,
}

impl Cells {
    fn push(&mut self, cell: &[u8]) {
        self.text.extend_from_slice(cell.trim_ascii());
        self.ends.push(self.text.len());
    }

    /// Returns the number of cells, without empty ones at the end of the line.
    pub(super) fn filled(&self) -> usize {
        let empty = |index: &usize| self.get(*index).is_some_and(<[u8]>::is_empty);
        self.ends.len() - (0..self.ends.len()).rev().take_while(empty).count()
    }

    /// Returns the number of cells.
    pub(super) const fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns a cell; `None` beyond the last one.
    pub(super) fn get(&self, index: usize) -> Option<&[u8]> {
        let end = *self.ends.get(index)?;
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.text.get(start..end)
    }

    /// Returns the cells in the order of the line.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.ends.len()).filter_map(|index| self.get(index))
    }
}

/// Layout of a table in a text file. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Layout {
    /// Separator of the cells.
    pub(crate) delimiter: Delimiter,
    /// Decimal sign of the numbers.
    pub(crate) decimal: char,
    /// Separator of thousands; `None` where numbers have none. Blanks within numbers are always ignored.
    pub(crate) thousands: Option<char>,
    /// Line with the names of the columns; `None` where they have none.
    pub(crate) header_line: Option<u64>,
    /// Line with the units of the columns; `None` where there is none.
    pub(crate) units_line: Option<u64>,
    /// First line of data.
    pub(crate) first_line: u64,
    /// Number of lines after the data.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) footer_lines: u64,
    /// Cells that stand for a missing value, beside empty ones and words such as `NaN` and `OVER`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) missing: Vec<String>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "the form that serde asks for"
)]
const fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl Layout {
    /// Parses a cell as a finite number; `None` if it is none. Thousands may be separated by the separator of
    /// the layout, blanks or apostrophes, with three digits after each.
    pub(super) fn number(&self, cell: &[u8]) -> Option<f64> {
        if !cell.is_ascii() {
            // the minus sign of typesetters, and blanks that do not break lines
            let plain = utf8_or_latin1(cell)
                .replace(['\u{2212}', '\u{2013}'], "-")
                .replace(['\u{a0}', '\u{202f}'], " ");
            return plain.is_ascii().then(|| self.number(plain.as_bytes()))?;
        }
        let mut plain = [0_u8; 48];
        let mut length = 0;
        // digits since the last separator of thousands, once there was one
        let mut group: Option<u8> = None;
        for &byte in cell {
            let sign = char::from(byte);
            let separates = byte == b' ' || byte == b'\'' || self.thousands == Some(sign);
            if separates && sign != self.decimal {
                let after_digit = length > 0 && plain[length - 1].is_ascii_digit();
                // `+    2.00`
                if !after_digit && byte == b' ' {
                    continue;
                }
                if !after_digit || group.is_some_and(|digits| digits != 3) {
                    return None;
                }
                group = Some(0);
                continue;
            }
            let kept = if sign == self.decimal { b'.' } else { byte };
            match kept {
                b'0'..=b'9' => group = group.map(|digits| digits.saturating_add(1)),
                b'+' | b'-' | b'.' | b'e' | b'E' => {
                    if group.take().is_some_and(|digits| digits != 3) {
                        return None;
                    }
                }
                _ => return None,
            }
            *plain.get_mut(length)? = kept;
            length += 1;
        }
        if group.is_some_and(|digits| digits != 3) {
            return None;
        }
        let digits = std::str::from_utf8(plain.get(..length)?).ok()?;
        digits.parse().ok().filter(|value: &f64| value.is_finite())
    }

    /// Returns whether a cell stands for a missing value.
    pub(super) fn is_missing(&self, cell: &[u8]) -> bool {
        let cell = utf8_or_latin1(cell);
        cell.is_empty() || means_missing(&cell) || self.missing.iter().any(|word| *word == cell)
    }
}

/// Words that loggers and spreadsheets write for a missing value.
const WORDS: [&str; 22] = [
    "nan", "-nan", "inf", "-inf", "infinity", "1.#inf", "na", "n/a", "null", "none", "-", "--",
    "---", "over", "ovr", "+over", "-over", "burnout", "#n/a", "#div/0!", "#value!", "#wert!",
];

/// Returns whether a text is a known word for a missing value.
pub(super) fn means_missing(word: &str) -> bool {
    WORDS.contains(&word.to_lowercase().as_str())
}

/// Returns whether a line is empty or a comment.
pub(super) fn is_comment(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    line.is_empty() || line.starts_with(b"#") || line.starts_with(b"%") || line.starts_with(b"//")
}

/// Returns the number for which a word stands, as in the column of a switch; `None` for any other word.
pub(super) fn switch(cell: &[u8]) -> Option<f64> {
    match utf8_or_latin1(cell).to_lowercase().as_str() {
        "true" | "on" => Some(1.0),
        "false" | "off" => Some(0.0),
        _ => None,
    }
}
