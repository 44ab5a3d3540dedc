//! Reader of exports for tests, with an independent reader for each format; included by the tests of this
//! crate and of the program.
use parquet::{
    file::reader::{FileReader as _, SerializedFileReader},
    record::Field,
};
use rusqlite::{Connection, OpenFlags, types::ValueRef};
use std::{
    collections::BTreeMap,
    fs::{self, File},
    path::Path,
};
use store::Format;

/// Value in one cell of a table read from an export.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Null,
    Integer(i64),
    Real(f64),
    Text(String),
}

/// Column names and rows of each table, by table name.
pub(crate) type Tables = BTreeMap<String, (Vec<String>, Vec<Vec<Value>>)>;

/// Reads all tables of an export.
pub(crate) fn tables(path: &Path, format: Format) -> Tables {
    match format {
        Format::Sqlite => sqlite(path),
        Format::Csv => csv(path),
        Format::Parquet => parquet(path),
    }
}

fn sqlite(path: &Path) -> Tables {
    let database = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY)
        .expect("it is a database");
    let whole: String = database
        .query_row("PRAGMA integrity_check", [], |row| row.get(0))
        .expect("it can be checked");
    assert_eq!(whole, "ok");
    let mut names = database
        .prepare("SELECT name FROM sqlite_schema WHERE type = 'table'")
        .expect("it has a schema");
    let names: Vec<String> = names
        .query_map([], |row| row.get(0))
        .expect("it has tables")
        .map(|name| name.expect("it has a name"))
        .collect();
    let read = |name: String| {
        let query = format!("SELECT * FROM \"{name}\" ORDER BY rowid");
        let mut statement = database.prepare(&query).expect("it can be read");
        let columns: Vec<String> = statement.column_names().map(str::to_owned).collect();
        let width = columns.len();
        let rows = statement
            .query_map([], |row| {
                (0..width)
                    .map(|place| {
                        Ok(match row.get_ref(place)? {
                            ValueRef::Null => Value::Null,
                            ValueRef::Integer(number) => Value::Integer(number),
                            ValueRef::Real(number) => Value::Real(number),
                            ValueRef::Text(text) | ValueRef::Blob(text) => {
                                Value::Text(String::from_utf8_lossy(text).into_owned())
                            }
                        })
                    })
                    .collect()
            })
            .expect("it has rows")
            .map(|row| row.expect("it can be read"))
            .collect();
        (name, (columns, rows))
    };
    names.into_iter().map(read).collect()
}

/// Returns the table name and path of each file in the folder of a CSV or Parquet export.
fn parts(folder: &Path) -> Vec<(String, std::path::PathBuf)> {
    fs::read_dir(folder)
        .expect("it is a folder")
        .map(|entry| {
            let path = entry.expect("it can be listed").path();
            let name = path.file_stem().expect("it has a name");
            (name.to_string_lossy().into_owned(), path.clone())
        })
        .collect()
}

fn csv(folder: &Path) -> Tables {
    let texts = |path: &Path| {
        let mut reader = ::csv::Reader::from_path(path).expect("it is there");
        let words = |record: &::csv::StringRecord| {
            record.iter().map(str::to_owned).collect::<Vec<String>>()
        };
        let head = words(reader.headers().expect("it has a head"));
        let rows: Vec<Vec<String>> = reader
            .records()
            .map(|record| words(&record.expect("it can be read")))
            .collect();
        (head, rows)
    };
    let (_, dictionary) = texts(&folder.join("dictionary.csv"));
    let kind = |table: &str, column: &str| {
        let entry = dictionary
            .iter()
            .find(|row| row[0] == table && row[1] == column)
            .expect("every column is in the dictionary");
        entry[2].clone()
    };
    let read = |(name, path): (String, std::path::PathBuf)| {
        let (head, rows) = texts(&path);
        let kinds: Vec<String> = head.iter().map(|column| kind(&name, column)).collect();
        let value = |(kind, text): (&String, String)| match kind.as_str() {
            _ if text.is_empty() => Value::Null,
            "integer" => Value::Integer(text.parse().expect("a whole number")),
            "real" => Value::Real(text.parse().expect("a number")),
            _ => Value::Text(text),
        };
        let rows = rows
            .into_iter()
            .map(|row| kinds.iter().zip(row).map(value).collect())
            .collect();
        (name, (head, rows))
    };
    parts(folder).into_iter().map(read).collect()
}

fn parquet(folder: &Path) -> Tables {
    let value = |field: &Field| {
        if let Field::Long(number) = field {
            Value::Integer(*number)
        } else if let Field::Double(number) = field {
            Value::Real(*number)
        } else if let Field::Str(text) = field {
            Value::Text(text.clone())
        } else {
            assert_eq!(*field, Field::Null);
            Value::Null
        }
    };
    let read = |(name, path): (String, std::path::PathBuf)| {
        let file = File::open(path).expect("it is there");
        let reader = SerializedFileReader::new(file).expect("it is Parquet");
        let schema = reader.metadata().file_metadata().schema_descr();
        let head = schema.columns().iter().map(|c| c.name().to_owned());
        let head = head.collect();
        let rows = reader
            .get_row_iter(None)
            .expect("it has rows")
            .map(|row| {
                let row = row.expect("it can be read");
                row.get_column_iter()
                    .map(|(_, field)| value(field))
                    .collect()
            })
            .collect();
        (name, (head, rows))
    };
    parts(folder).into_iter().map(read).collect()
}
