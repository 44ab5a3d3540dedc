//! Columns: each is defined once, with its name, its meaning and how it is read from a row.
//!
//! Knows neither what the rows are of nor in which form they are written.

/// The name of every job column: databases look rows up by it.
pub(super) const JOB: &str = "job";

/// What a field holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// Nothing: the value does not exist.
    Null,
    /// A whole number.
    Integer(i64),
    /// A finite number.
    Real(f64),
    /// Words.
    Text(String),
}

/// What the fields of a column hold, where they hold something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// [`Value::Integer`].
    Integer,
    /// [`Value::Real`].
    Real,
    /// [`Value::Text`].
    Text,
}

impl Kind {
    /// As written in the dictionary.
    pub(super) const fn as_str(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Real => "real",
            Self::Text => "text",
        }
    }
}

/// A column as files show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    /// Its name, with the unit.
    pub(super) name: String,
    /// What it holds.
    pub(super) kind: Kind,
    /// What it means.
    pub(super) about: String,
}

type Read<R> = Box<dyn Fn(&R) -> Value>;

/// The columns of a table whose rows are made of `R`.
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

    /// A column of whole numbers; one too large for a database is none.
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

    /// A column of numbers; what is not finite is none.
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

    /// A column of words; no words are none, since not every form can tell the two apart.
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

    /// The columns of a part of the row.
    pub(super) fn with<S: 'static>(mut self, part: Columns<S>, of: fn(&R) -> &S) -> Self {
        self.columns.extend(part.columns);
        let read = part.read.into_iter();
        self.read
            .extend(read.map(|read| -> Read<R> { Box::new(move |row| read(of(row))) }));
        self
    }

    /// What files show of them.
    pub(super) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The fields of a row.
    pub(super) fn fields(&self, row: &R) -> Vec<Value> {
        self.read.iter().map(|read| read(row)).collect()
    }
}
