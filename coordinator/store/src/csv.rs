//! Tables as CSV: one file each, an empty field for a missing value, numbers with all digits.
use super::{
    column::Value,
    error::StoreError,
    writer::{Schema, Sink},
};
use std::{
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
};

/// Writer of an export in CSV format, one file per table in a folder.
pub(super) struct CsvFiles {
    folder: PathBuf,
    files: Vec<(PathBuf, csv::Writer<BufWriter<File>>)>,
}

impl CsvFiles {
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            files: Vec::new(),
        }
    }
}

fn field(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::Integer(number) => number.to_string(),
        Value::Real(number) => number.to_string(),
        Value::Text(text) => text.clone(),
    }
}

impl Sink for CsvFiles {
    fn begin(&mut self, shape: &Schema) -> Result<(), StoreError> {
        let path = self.folder.join(format!("{}.csv", shape.name));
        let failed = StoreError::writing(&path);
        let file = File::create(&path).map_err(failed)?;
        let mut writer = csv::Writer::from_writer(BufWriter::new(file));
        let names = shape.columns.iter().map(|column| column.name.as_str());
        let written = writer.write_record(names);
        written.map_err(|error| StoreError::table(&path, error))?;
        self.files.push((path, writer));
        Ok(())
    }

    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError> {
        let Some((path, writer)) = self.files.get_mut(place) else {
            return Ok(());
        };
        for row in rows {
            let written = writer.write_record(row.iter().map(field));
            written.map_err(|error| StoreError::table(path, error))?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), StoreError> {
        for (path, writer) in self.files {
            let failed = || StoreError::writing(&path);
            let inner = writer
                .into_inner()
                .map_err(|error| failed()(error.into_error()))?;
            let file = inner
                .into_inner()
                .map_err(|error| failed()(error.into_error()))?;
            file.sync_all().map_err(failed())?;
        }
        Ok(())
    }
}
