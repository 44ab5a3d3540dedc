//! Parsing of TOML files into typed data, with errors that show the source line and the nearest known key.
use super::{
    conversion::{convert, convert_key, factor},
    error::{CaseError, damaged},
    file,
};
use serde::de::DeserializeOwned;
use std::{
    fmt::Display,
    ops::{Range, RangeInclusive},
    path::{Path, PathBuf},
};
use toml::de::{DeTable, DeValue};

/// TOML file that was read; its text is kept for the excerpts of later error messages.
#[derive(Debug)]
pub struct Document {
    /// Path of the TOML file.
    pub path: PathBuf,
    text: String,
}

/// Step of the path to a field of a TOML file: a table key or an array index.
#[derive(Debug, Clone, Copy)]
pub enum DocumentStep<'a> {
    /// Key of a table.
    Key(&'a str),
    /// Index of an entry of an array.
    Index(usize),
}

impl Document {
    /// Creates a document from its text; `path` is for messages.
    pub const fn new(path: PathBuf, text: String) -> Self {
        Self { path, text }
    }

    /// Returns the text of the TOML file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Reads a TOML file; `role` states for the error message what the file is needed for.
    ///
    /// # Errors
    /// Returns an error for a file that is missing, unreadable, empty or not text.
    pub fn read(path: &Path, role: &str) -> Result<Self, CaseError> {
        let bytes = file::read(path, role)?;
        let text = file::text(path, bytes)?;
        Ok(Self {
            path: path.to_owned(),
            text,
        })
    }

    /// Parses the text of the TOML file into a type.
    ///
    /// # Errors
    /// Returns an error for invalid syntax, an unknown key (with the nearest known one), a missing key or a
    /// value of another type.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, CaseError> {
        toml::from_str(&self.text).map_err(|error| {
            let message = error.message();
            CaseError::Toml {
                path: self.path.as_path().into(),
                problem: first_line(message).into(),
                excerpt: error
                    .span()
                    .map(|span| self.excerpt(span))
                    .unwrap_or_default()
                    .into(),
                help: advice(message).into(),
            }
        })
    }

    /// Builds the error for a value that is not allowed in a field, with the field's source line.
    pub fn field(
        &self,
        keys: &[DocumentStep<'_>],
        value: impl Display,
        allowed: impl Into<String>,
        help: &str,
    ) -> CaseError {
        CaseError::Field {
            path: self.path.as_path().into(),
            field: dotted(keys).into(),
            value: value.to_string().into(),
            allowed: allowed.into().into(),
            excerpt: self
                .span(keys)
                .map(|span| self.excerpt(span))
                .unwrap_or_default()
                .into(),
            help: help.into(),
        }
    }

    /// Checks that a number of the file lies in a closed interval; NaN is refused.
    ///
    /// # Errors
    /// Returns an error with the field, its value and the interval with its unit.
    pub fn within(
        &self,
        dotted: &str,
        value: f64,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<(), CaseError> {
        if range.contains(&value) {
            return Ok(());
        }
        let keys: Vec<DocumentStep<'_>> = dotted.split('.').map(DocumentStep::Key).collect();
        Err(self.field(
            &keys,
            value,
            format!(
                "{} to {} {unit}",
                short(*range.start()),
                short(*range.end())
            ),
            "correct the value; the unit is the end of the key's name",
        ))
    }

    /// Builds the error for a word of a text that is no TOML, with its source line.
    pub fn place(&self, at: usize, word: &str, allowed: &str, help: &str) -> CaseError {
        let line = 1 + self
            .text
            .get(..at)
            .unwrap_or_default()
            .matches('\n')
            .count();
        CaseError::Field {
            path: self.path.as_path().into(),
            field: format!("line {line}").into(),
            value: format!("\"{word}\"").into(),
            allowed: allowed.into(),
            excerpt: self.excerpt(at..at + word.len()).into(),
            help: help.into(),
        }
    }

    /// Returns the byte range of a field in the text of the TOML file.
    fn span(&self, keys: &[DocumentStep<'_>]) -> Option<Range<usize>> {
        let root = DeTable::parse(&self.text).ok()?;
        let (first, rest) = keys.split_first()?;
        let DocumentStep::Key(key) = first else {
            return None;
        };
        let mut at = root.get_ref().get(*key)?;
        for step in rest {
            at = match (step, at.get_ref()) {
                (DocumentStep::Key(key), DeValue::Table(table)) => table.get(*key)?,
                (DocumentStep::Index(index), DeValue::Array(array)) => array.get(*index)?,
                _ => return Some(at.span()),
            };
        }
        Some(at.span())
    }

    /// Returns the TOML source line at a byte range, with a marker line below it.
    fn excerpt(&self, span: Range<usize>) -> String {
        let before = self.text.get(..span.start).unwrap_or_default();
        let line = before.matches('\n').count();
        let column = before.chars().rev().take_while(|c| *c != '\n').count();
        let Some(source) = self.text.lines().nth(line) else {
            return String::new();
        };
        let (source, column) = around(source, column);
        let room = source.chars().count().saturating_sub(column).max(1);
        let width = span.end.saturating_sub(span.start).clamp(1, room);
        let number = (line + 1).to_string();
        let gutter = " ".repeat(number.len());
        format!(
            "\n{gutter} |\n{number} | {source}\n{gutter} | {}{}",
            " ".repeat(column),
            "^".repeat(width)
        )
    }
}

/// Shortens a source line of more than 120 characters to the characters around a column; returns these and
/// the column within them.
fn around(line: &str, column: usize) -> (String, usize) {
    const WIDEST: usize = 120;
    const BEFORE: usize = 60;
    if line.chars().count() <= WIDEST {
        return (line.to_owned(), column);
    }
    let from = column.saturating_sub(BEFORE);
    let part: String = line.chars().skip(from).take(WIDEST).collect();
    if from == 0 {
        return (part + " ...", column);
    }
    (format!("... {part}"), column - from + 4)
}

/// Formats the path to a field as in messages: `conditions[0].speed_rpm`.
fn dotted(keys: &[DocumentStep<'_>]) -> String {
    let mut text = String::new();
    for step in keys {
        match step {
            DocumentStep::Key(key) if text.is_empty() => text.push_str(key),
            DocumentStep::Key(key) => {
                text.push('.');
                text.push_str(key);
            }
            DocumentStep::Index(index) => {
                text.push('[');
                text.push_str(&index.to_string());
                text.push(']');
            }
        }
    }
    text
}

/// Formats a number without superfluous digits: in exponential notation below 1e-3 and from 1e5 on.
pub fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Text that separates the expectation from an example in the serde `expecting` messages of case-file types.
const EXAMPLE_SEPARATOR: &str = "; write ";

/// Wording of error messages for a value that must be a non-negative integer.
const EXPECTED_COUNT: &str = "expected a whole number, 0 or greater";

/// Returns the first line of a TOML library message, without its list of alternatives and with Rust type
/// names replaced by plain words.
fn first_line(message: &str) -> String {
    let line = message.lines().next().unwrap_or_default();
    let line = line
        .split_once(EXAMPLE_SEPARATOR)
        .map_or(line, |(line, _)| line);
    match line.split_once(", expected ") {
        Some((head, _)) if line.starts_with("unknown ") => head.to_owned(),
        // types of the source are nothing to people who write files
        Some((head, kind)) if kind.starts_with("struct ") => format!("{head}, expected a table"),
        _ => line
            .replace("expected f64", "expected a number")
            .replace("expected u8", "expected a whole number from 0 to 255")
            .replace("expected usize", EXPECTED_COUNT)
            .replace("expected u32", EXPECTED_COUNT)
            .replace("expected u64", EXPECTED_COUNT)
            .replace("expected i64", "expected a whole number"),
    }
}

/// Returns the remedy that a user is offered for an error message of the TOML library.
fn advice(message: &str) -> String {
    let mut quoted = message.split('`').skip(1).step_by(2);
    if message.starts_with("unknown field") || message.starts_with("unknown variant") {
        let what = quoted.next().unwrap_or_default();
        let known: Vec<&str> = quoted.collect();
        let list = known.join(", ");
        let choice = message.starts_with("unknown variant");
        if !choice && let Some(conversion) = convert_key(what, &known) {
            return conversion;
        }
        if choice && let Some(unit) = known.iter().find(|unit| factor(what, unit).is_some()) {
            return format!("{}; known here: {list}", convert(what, unit));
        }
        return match nearest(what, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? known here: {list}"),
            None if choice => format!("choose one of: {list}"),
            None => format!("remove it; known here: {list}"),
        };
    }
    if message.starts_with("missing field") {
        let what = quoted.next().unwrap_or_default();
        return match what {
            "unit" => format!("add `unit = \"...\"`: one of {}", units()),
            _ => format!("add `{what}`; `horsehead case new` prints a commented template"),
        };
    }
    if let Some((_, example)) = message.split_once(EXAMPLE_SEPARATOR) {
        let example = example.lines().next().unwrap_or_default();
        return format!("write {example}; units: {}", units());
    }
    if message.starts_with("invalid type") {
        return "correct the value's type: numbers without quotes, names with quotes".to_owned();
    }
    "correct the marked place; the file must be TOML 1.0".to_owned()
}

/// Returns the symbols of all units that an unknown may have, as a list for messages.
pub fn units() -> String {
    protocol::unit::Unit::ALL
        .map(protocol::unit::Unit::symbol)
        .join(", ")
}

/// Prefixes that reverse the meaning of a word; words that differ by one of them are never suggested for each
/// other.
const OPPOSITE: [&str; 4] = ["anti", "counter", "un", "non"];

/// Returns the candidate most similar to a word, if the similarity is at least 0.5; never a candidate of
/// opposite meaning.
pub fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase().replace(['-', ' '], "_");
    let word = lower.strip_prefix("anti").map_or(lower.clone(), |rest| {
        format!("counter_{}", rest.trim_start_matches('_'))
    });
    let word = word.as_str();
    let opposite = |candidate: &str| {
        let before = word.strip_suffix(candidate).unwrap_or_default();
        OPPOSITE.contains(&before.trim_end_matches('_'))
    };
    candidates
        .filter(|candidate| !opposite(candidate))
        .map(|candidate| {
            let alike = strsim::normalized_damerau_levenshtein(word, &candidate.to_lowercase());
            // a key that lacks its unit is the commonest slip: `mass` for `mass_kg`
            let prefix = candidate.starts_with(word) && word.len() >= 3;
            (candidate, if prefix { alike.max(0.9) } else { alike })
        })
        .filter(|(_, alike)| *alike >= 0.5)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(candidate, _)| candidate)
}

/// Parses JSON.
///
/// # Errors
/// Returns an error with the file's name and the line and column of the first problem.
pub fn json<T: DeserializeOwned>(path: &Path, bytes: &[u8]) -> Result<T, CaseError> {
    serde_json::from_slice(bytes).map_err(|error| {
        damaged(
            path,
            format!("the JSON cannot be used: {error}"),
            "copy the file again from its source; keys and lengths are described in the case's README",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::{advice, around, first_line, nearest};

    /// Checks that an error message shows only the part of a long source line around the error; a line of
    /// 100,000 brackets once filled the terminal.
    #[test]
    fn of_a_long_line_only_what_is_around_the_place_is_shown() {
        assert_eq!(around("a = 1", 4), ("a = 1".to_owned(), 4));
        let long: String = "0123456789".repeat(100);
        for column in [0, 5, 61, 500, 999] {
            let (shown, at) = around(&long, column);
            assert!(shown.chars().count() <= 124, "{column}");
            assert_eq!(shown.chars().nth(at), long.chars().nth(column), "{column}");
        }
    }

    /// Checks that the suggested word never has the opposite meaning; `anticlockwise` was once corrected to
    /// `clockwise`.
    #[test]
    fn the_nearest_word_is_never_the_opposite() {
        let senses = ["clockwise", "counter_clockwise"];
        for (word, meant) in [
            ("anticlockwise", "counter_clockwise"),
            ("anti-clockwise", "counter_clockwise"),
            ("counterclockwise", "counter_clockwise"),
            ("Counter Clockwise", "counter_clockwise"),
            ("clockwize", "clockwise"),
            ("Clockwise", "clockwise"),
        ] {
            assert_eq!(nearest(word, senses.into_iter()), Some(meant), "{word}");
        }
        assert_eq!(nearest("unmeasured", ["measured"].into_iter()), None);
        let units = ["N/m", "N.m"];
        assert_eq!(nearest("N/M", units.into_iter()), Some("N/m"));
    }

    #[test]
    fn the_words_of_the_library_become_what_to_write() {
        let table = "invalid type: floating point `3.14e8`, expected struct Beam with 2 elements";
        assert!(first_line(table).ends_with("`3.14e8`, expected a table"));
        let gene =
            "invalid type: floating point `3.14e8`, expected a value; write `{ value = 1.0 }`";
        assert!(first_line(gene).ends_with("expected a value"));
        assert!(advice(gene).starts_with("write `{ value = 1.0 }`; units: "));
        let number = "invalid type: string \"4\", expected f64";
        assert!(first_line(number).ends_with("expected a number"));
        let count = "invalid type: floating point `2.5`, expected usize";
        assert!(first_line(count).ends_with("expected a whole number, 0 or greater"));
        let choice = "unknown variant `sideways`, expected `free` or `fixed`";
        assert_eq!(advice(choice), "choose one of: free, fixed");
        let field = "unknown field `zzzzzz`, expected `name` or `run`";
        assert!(advice(field).starts_with("remove it"));
    }
}
