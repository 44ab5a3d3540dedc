//! Column definitions of the exported tables: each column is defined once, with its name, its meaning and the
//! function that reads its value from a row.
//!
//! Independent of the type of the rows and of the file format.

/// Name of the job number column in every exported table that has one; databases get an index on it.
pub(super) const JOB: &str = "job";

/// Value in one cell of an exported table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Null,
    Integer(i64),
    /// Finite real number.
    Real(f64),
    Text(String),
}

/// Type of the values in a column of an exported table; every column may also hold missing values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Integer,
    Real,
    Text,
}

impl Kind {
    /// Returns the name of the type, as written in the dictionary table.
    pub(super) const fn as_str(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Real => "real",
            Self::Text => "text",
        }
    }
}

/// Description of one column of an exported table: name, type and meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    /// Name of the column, including the unit of its values.
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Meaning of the column's values, as written in the export's dictionary table.
    pub(super) about: String,
}

type Read<R> = Box<dyn Fn(&R) -> Value>;

/// Columns of a table whose rows are made from `R`, with the functions that read their values.
pub(super) struct Columns<R> {
    columns: Vec<Column>,
    read: Vec<Read<R>>,
}

impl<R: 'static> Columns<R> {
    pub(super) const fn new() -> Self {
        Self {
            columns: Vec::new(),
            read: Vec::new(),
        }
    }

    fn add(mut self, name: &str, about: &str, kind: Kind, read: Read<R>) -> Self {
        self.columns.push(Column {
            name: name.to_owned(),
            kind,
            about: about.to_owned(),
        });
        self.read.push(read);
        self
    }

    /// Adds a column of integers; a number too large for `i64` becomes a missing value.
    pub(super) fn integer(
        self,
        name: &str,
        about: &str,
        read: impl Fn(&R) -> Option<u64> + 'static,
    ) -> Self {
        let value = move |row: &R| {
            let number = read(row).and_then(|number| i64::try_from(number).ok());
            number.map_or(Value::Null, Value::Integer)
        };
        self.add(name, about, Kind::Integer, Box::new(value))
    }

    /// Adds a column of real numbers; a number that is not finite becomes a missing value.
    pub(super) fn real(
        self,
        name: &str,
        about: &str,
        read: impl Fn(&R) -> Option<f64> + 'static,
    ) -> Self {
        let value = move |row: &R| {
            let number = read(row).filter(|number| number.is_finite());
            number.map_or(Value::Null, Value::Real)
        };
        self.add(name, about, Kind::Real, Box::new(value))
    }

    /// Adds a column of text; an empty text becomes a missing value, since CSV cannot distinguish the two.
    pub(super) fn text(
        self,
        name: &str,
        about: &str,
        read: impl Fn(&R) -> Option<String> + 'static,
    ) -> Self {
        let value = move |row: &R| {
            let words = read(row).filter(|words| !words.is_empty());
            words.map_or(Value::Null, Value::Text)
        };
        self.add(name, about, Kind::Text, Box::new(value))
    }

    /// Adds the columns of a nested part of the row type; `of` returns this part of a row.
    pub(super) fn with<S: 'static>(mut self, part: Columns<S>, of: fn(&R) -> &S) -> Self {
        self.columns.extend(part.columns);
        let read = part.read.into_iter();
        self.read
            .extend(read.map(|read| -> Read<R> { Box::new(move |row| read(of(row))) }));
        self
    }

    pub(super) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Returns the values of one row, in the order of the columns.
    pub(super) fn fields(&self, row: &R) -> Vec<Value> {
        self.read.iter().map(|read| read(row)).collect()
    }
}
