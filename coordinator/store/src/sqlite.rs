//! Tables as one SQLite database, written in a single transaction.
//!
//! The file becomes visible only when it is complete; the database is therefore written without a rollback
//! journal and without synchronisation.
use super::{
    column::{JOB, Kind, Value},
    error::StoreError,
    writer::{Schema, Sink},
};
use rusqlite::{
    Connection, ToSql, params_from_iter,
    types::{ToSqlOutput, Value as Field, ValueRef},
};
use std::{
    fs::File,
    path::{Path, PathBuf},
};

/// SQLite application id that marks a database as an export of this program: `HHRN`.
pub(super) const APPLICATION: i32 = 0x4848_524e;

/// Version of the table schema, stored as SQLite `user_version`.
const VERSION: i32 = 1;

/// Writer of an export as one SQLite database.
pub(super) struct Database {
    path: PathBuf,
    connection: Connection,
    /// For each table its name, its `INSERT` statement, and whether it gets an index on the job number.
    tables: Vec<(&'static str, String, bool)>,
}

impl Database {
    /// Creates the database file, which must not exist.
    pub(super) fn create(path: &Path) -> Result<Self, StoreError> {
        let failed = |error| StoreError::table(path, error);
        let connection = Connection::open(path).map_err(failed)?;
        let begin = format!(
            "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA application_id = \
             {APPLICATION}; PRAGMA user_version = {VERSION}; BEGIN"
        );
        connection.execute_batch(&begin).map_err(failed)?;
        Ok(Self {
            path: path.to_owned(),
            connection,
            tables: Vec::new(),
        })
    }
}

impl ToSql for Value {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(match self {
            Self::Null => ToSqlOutput::Owned(Field::Null),
            Self::Integer(number) => ToSqlOutput::Owned(Field::Integer(*number)),
            Self::Real(number) => ToSqlOutput::Owned(Field::Real(*number)),
            Self::Text(text) => ToSqlOutput::Borrowed(ValueRef::Text(text.as_bytes())),
        })
    }
}

const fn type_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Integer => "INTEGER",
        Kind::Real => "REAL",
        Kind::Text => "TEXT",
    }
}

impl Sink for Database {
    fn begin(&mut self, shape: &Schema) -> Result<(), StoreError> {
        let name = shape.name;
        let columns = shape.columns.iter();
        let columns: Vec<String> = columns
            .map(|column| format!("\"{}\" {}", column.name, type_name(column.kind)))
            .collect();
        let table = format!("CREATE TABLE \"{name}\" ({}) STRICT", columns.join(", "));
        self.connection
            .execute_batch(&table)
            .map_err(|error| StoreError::table(&self.path, error))?;
        let places = vec!["?"; columns.len()].join(", ");
        let add = format!("INSERT INTO \"{name}\" VALUES ({places})");
        let by_job = shape.columns.iter().any(|column| column.name == JOB);
        self.tables.push((name, add, by_job));
        Ok(())
    }

    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError> {
        let Some((_, add, _)) = self.tables.get(place) else {
            return Ok(());
        };
        let fill = || -> rusqlite::Result<()> {
            let mut statement = self.connection.prepare(add)?;
            for row in rows {
                statement.execute(params_from_iter(row))?;
            }
            Ok(())
        };
        fill().map_err(|error| StoreError::table(&self.path, error))
    }

    fn finish(self: Box<Self>) -> Result<(), StoreError> {
        let Self {
            path,
            connection,
            tables,
        } = *self;
        let by_job = tables.iter().filter(|(_, _, by_job)| *by_job);
        let index = |(name, _, _): &(&str, String, bool)| {
            format!("CREATE INDEX \"{name}_{JOB}\" ON \"{name}\" (\"{JOB}\"); ")
        };
        let mut end: String = by_job.map(index).collect();
        end.push_str("COMMIT");
        let failed = |error| StoreError::table(&path, error);
        connection.execute_batch(&end).map_err(failed)?;
        connection.close().map_err(|(_, error)| failed(error))?;
        let synced = File::open(&path).and_then(|file| file.sync_all());
        synced.map_err(StoreError::writing(&path))
    }
}
