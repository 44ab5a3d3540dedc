//! Rows of a control file's tables: the words of a line, or the cells of a CSV file under its header.
use super::lines::{Lines, Section};
use crate::{Problem, number, problem::clip, table::TextTable};
use std::collections::BTreeMap;

/// Row of a table in a control file: its file and line, and its cells by column name.
pub(super) struct Row {
    pub(super) file: String,
    pub(super) line: usize,
    cells: BTreeMap<String, String>,
}

impl Row {
    /// Creates a row that assigns the words of a line to the column names in order.
    pub(super) fn of(file: &str, line: usize, names: &[&str], words: &[&str]) -> Self {
        let cells = names.iter().zip(words);
        Self {
            file: file.to_owned(),
            line,
            cells: cells
                .map(|(name, word)| ((*name).to_owned(), (*word).to_owned()))
                .collect(),
        }
    }

    /// Returns the cell of the named column in lower case, which must be one of some words.
    ///
    /// # Errors
    /// Another word.
    pub(super) fn one_of(
        &self,
        name: &str,
        words: &[&'static str],
    ) -> Result<&'static str, Problem> {
        let Ok(cell) = self.word(name) else {
            return Ok(words.first().copied().unwrap_or_default());
        };
        let known = words.iter().find(|word| **word == cell);
        known.copied().ok_or_else(|| {
            let allowed = format!("one of {}", words.join(", "));
            self.problem(format!("{name} = `{}`", clip(&cell)), &allowed)
        })
    }

    /// Returns the names of the columns that have a value.
    pub(super) fn columns(&self) -> impl Iterator<Item = &str> {
        let filled = self.cells.iter().filter(|(_, cell)| !cell.is_empty());
        filled.map(|(name, _)| name.as_str())
    }

    /// Creates the error for a fault in the row.
    pub(super) fn problem(&self, found: String, allowed: &str) -> Problem {
        Problem::at(
            &self.file,
            self.line,
            found,
            allowed,
            "correct the control file",
        )
    }

    /// Returns the cell of the named column in lower case.
    pub(super) fn word(&self, name: &str) -> Result<String, Problem> {
        self.plain(name).map(|cell| cell.to_lowercase())
    }

    /// Returns the cell of the named column unchanged.
    pub(super) fn plain(&self, name: &str) -> Result<String, Problem> {
        let found = self.cells.get(name).filter(|cell| !cell.is_empty());
        found.cloned().ok_or_else(|| {
            self.problem(
                "a row that is too short".to_owned(),
                &format!("a row with a value for {name}"),
            )
        })
    }

    /// Returns a cell in lower case, or `other` if the cell is missing.
    pub(super) fn word_or(&self, name: &str, other: &str) -> String {
        self.word(name).unwrap_or_else(|_| other.to_owned())
    }

    /// Parses the cell of the named column as a finite number.
    pub(super) fn number(&self, name: &str) -> Result<f64, Problem> {
        let cell = self.plain(name)?;
        number(&cell)
            .ok_or_else(|| self.problem(format!("{name} = `{}`", clip(&cell)), "a finite number"))
    }

    /// Parses a cell as a finite number; returns `other` if the cell is missing or empty.
    pub(super) fn number_or(&self, name: &str, other: f64) -> Result<f64, Problem> {
        if self.cells.get(name).is_none_or(String::is_empty) {
            return Ok(other);
        }
        self.number(name)
    }
}

/// Returns the rows of a section: its own lines, followed by those of the CSV files named by the section of
/// the same name with the suffix `external`. Empty if neither section exists.
pub(super) fn rows(
    lines: &Lines,
    name: &str,
    columns: &[&str],
    open: &dyn Fn(&str) -> Result<String, String>,
) -> Result<Vec<Row>, Problem> {
    let mut all = Vec::new();
    if let Some(section) = lines.section(name) {
        for line in &section.lines {
            let words: Vec<&str> = line.text.split_whitespace().collect();
            all.push(Row::of(&lines.file, line.number, columns, &words));
        }
    }
    let external = lines
        .sections
        .iter()
        .filter(|section| section.name == format!("{name} external"));
    for section in external {
        all.extend(files(lines, section, open)?);
    }
    Ok(all)
}

/// Reads the table rows of the files named by a control file section with the suffix `external`.
fn files(
    lines: &Lines,
    section: &Section,
    open: &dyn Fn(&str) -> Result<String, String>,
) -> Result<Vec<Row>, Problem> {
    let mut all = Vec::new();
    for line in &section.lines {
        let mut words = line.text.split_whitespace();
        let file = words.next().unwrap_or_default();
        let refused = |found: String, allowed: &str| lines.problem(line.number, found, allowed);
        // the separator is that of the header, whatever `sep` says
        let mut missing = None;
        while let Some(word) = words.next() {
            let value = words.next();
            match (word.to_lowercase().as_str(), value) {
                ("sep", Some(_)) => {}
                ("missing_value" | "missing_values", Some(value)) => missing = Some(value),
                _ => {
                    let allowed = "the name of a table, with `sep` and `missing_value` or without";
                    return Err(refused(format!("`{}`", clip(&line.text)), allowed));
                }
            }
        }
        let text = open(file)
            .map_err(|error| refused(format!("{file}: {error}"), "a file that can be read"))?;
        let table = TextTable::parse(&text, &[]);
        let names: Vec<String> = table.names.iter().map(|name| name.to_lowercase()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        for row in 0..table.len() {
            let (width, line) = (table.width(row), table.line(row));
            let is_short = width < names.len();
            if width > names.len() || (is_short && !table.is_blank_separated()) {
                let found = format!("a row of {width} cells");
                let allowed = format!("{} cells, as in the header", names.len());
                return Err(Problem::at(file, line, found, allowed, "correct the table"));
            }
            let cells = (0..names.len()).map(|column| table.cell(row, column));
            let cells = cells.map(|cell| if Some(cell) == missing { "" } else { cell });
            let cells: Vec<&str> = cells.collect();
            all.push(Row::of(file, line, &names, &cells));
        }
    }
    Ok(all)
}
