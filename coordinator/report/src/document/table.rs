//! Table model, independent of the output format.
use protocol::case::Unknown;
use serde::{Deserialize, Serialize};

/// Table with a title, column heads, rows and notes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Title of the table.
    pub title: String,
    /// Headings of the table's columns; the first is that of the row labels.
    pub head: Vec<String>,
    /// Rows from top to bottom.
    pub rows: Vec<Row>,
    /// Definitions and remarks printed below the table, one sentence each.
    pub notes: Vec<String>,
}

/// Row of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Row {
    /// Subheading of the rows that follow.
    Group(String),
    /// Row label, and one cell for each column after the first.
    Values(Label, Vec<String>),
}

/// Label of a row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Label {
    /// Label in plain text.
    Text(String),
    /// Label that names an unknown of the case.
    Unknown {
        /// Name of the unknown.
        name: String,
        /// Title of the unknown in words.
        title: String,
        /// Symbol of the unknown, typeset in HTML; `_` separates the index.
        symbol: String,
    },
}

impl Table {
    /// Creates a table without notes.
    pub fn new<const N: usize>(title: impl Into<String>, head: [&str; N], rows: Vec<Row>) -> Self {
        Self {
            title: title.into(),
            head: head.map(str::to_owned).to_vec(),
            rows,
            notes: Vec::new(),
        }
    }

    /// Returns the table with notes appended.
    #[must_use]
    pub fn with_notes(mut self, notes: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.notes.extend(notes.into_iter().map(Into::into));
        self
    }

    /// Returns the table, or `None` if it has no rows.
    pub fn non_empty(self) -> Option<Self> {
        (!self.rows.is_empty()).then_some(self)
    }

    /// Returns the width of the widest cell of a column, without the head (columns of a terminal).
    pub(super) fn widest_cell(&self, column: usize) -> u16 {
        let cells = self.rows.iter().filter_map(|row| match row {
            Row::Group(_) => None,
            Row::Values(_, cells) => cells.get(column),
        });
        let widest = cells.map(|cell| cell.chars().count()).max();
        u16::try_from(widest.unwrap_or_default()).unwrap_or(u16::MAX)
    }

    /// Returns whether a column holds text instead of numbers; text columns are left-aligned and may wrap.
    pub(super) fn is_prose(&self, column: usize) -> bool {
        const LONGEST_NUMBER: usize = 32;
        let cells = self.rows.iter().filter_map(|row| match row {
            Row::Group(_) => None,
            Row::Values(_, cells) => cells.get(column),
        });
        let mut lengths = cells.map(|cell| cell.chars().count());
        lengths.any(|length| length > LONGEST_NUMBER)
    }
}

impl Row {
    /// Creates a table row from a text label and its cells.
    pub fn new(label: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Self {
        Self::Values(Label::Text(label.into()), cells.into_iter().collect())
    }

    /// Creates a row for an unknown; a parameter of an effect, and an unknown without a title, is labelled by its name
    /// alone.
    pub(crate) fn of(unknown: &Unknown, cells: impl IntoIterator<Item = String>) -> Self {
        let has_title = unknown.title != unknown.name || unknown.symbol != unknown.name;
        let label = if unknown.of_effect().is_none() && has_title {
            Label::Unknown {
                name: unknown.name.clone(),
                title: unknown.title.clone(),
                symbol: unknown.symbol.clone(),
            }
        } else {
            Label::Text(unknown.name.clone())
        };
        Self::Values(label, cells.into_iter().collect())
    }

    /// Creates the subheading of a group of rows.
    pub fn group(name: impl Into<String>) -> Self {
        Self::Group(name.into())
    }
}
