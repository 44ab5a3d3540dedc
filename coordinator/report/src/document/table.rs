//! A table before it is set as text or as HTML.
use protocol::case::Unknown;

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Heads of the columns; the first belongs to the labels.
    pub head: Vec<String>,
    /// Rows from top to bottom.
    pub rows: Vec<Row>,
    /// Definitions and remarks below it, one sentence each.
    pub notes: Vec<String>,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Heads the rows that follow.
    Group(String),
    /// A label and one cell per further column.
    Values(Label, Vec<String>),
}

/// What a row is about.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    /// In words.
    Text(String),
    /// An unknown of the case.
    Unknown {
        /// Its name.
        name: String,
        /// What it is, in words.
        title: String,
        /// Its symbol, set where the medium can; an index behind `_`.
        symbol: String,
    },
}

impl Table {
    /// A table without notes.
    pub fn new<const N: usize>(title: impl Into<String>, head: [&str; N], rows: Vec<Row>) -> Self {
        Self {
            title: title.into(),
            head: head.map(str::to_owned).to_vec(),
            rows,
            notes: Vec::new(),
        }
    }

    /// The same with notes behind those that it has.
    #[must_use]
    pub fn noted(mut self, notes: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.notes.extend(notes.into_iter().map(Into::into));
        self
    }

    /// The table, unless it has no rows.
    pub(crate) fn unless_empty(self) -> Option<Self> {
        (!self.rows.is_empty()).then_some(self)
    }

    /// Whether a column holds words, not numbers: those start at the left, and may be long.
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
    /// A row about something in words.
    pub fn new(label: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Self {
        Self::Values(Label::Text(label.into()), cells.into_iter().collect())
    }

    /// A row about an unknown; of a parameter of an effect the name says it all.
    pub(crate) fn of(unknown: &Unknown, cells: impl IntoIterator<Item = String>) -> Self {
        let label = match unknown.of_effect() {
            Some(_) => Label::Text(unknown.name.clone()),
            None => Label::Unknown {
                name: unknown.name.clone(),
                title: unknown.title.clone(),
                symbol: unknown.symbol.clone(),
            },
        };
        Self::Values(label, cells.into_iter().collect())
    }

    /// The head of a group of rows.
    pub fn group(name: impl Into<String>) -> Self {
        Self::Group(name.into())
    }
}
