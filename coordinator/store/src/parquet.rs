//! Writer of the exported tables as Parquet: one file per table, every column optional, text as UTF-8.
use super::{
    column::{Kind, Value},
    error::StoreError,
    writer::{Schema, Sink},
};
use parquet::{
    basic::{LogicalType, Repetition, Type as Physical},
    data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type},
    errors::ParquetError,
    file::{
        properties::WriterProperties,
        writer::{SerializedColumnWriter, SerializedFileWriter},
    },
    schema::types::{Type, TypePtr},
};
use std::{
    fs::File,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Writer of an export in Parquet format, one file per table in a folder; each batch of rows becomes one row
/// group.
pub(super) struct ParquetFiles {
    folder: PathBuf,
    files: Vec<(PathBuf, Vec<Kind>, SerializedFileWriter<File>)>,
}

impl ParquetFiles {
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            files: Vec::new(),
        }
    }
}

fn schema(shape: &Schema) -> Result<TypePtr, ParquetError> {
    let fields = shape.columns.iter().map(|column| {
        let (physical, logical) = match column.kind {
            Kind::Integer => (Physical::INT64, None),
            Kind::Real => (Physical::DOUBLE, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&column.name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical);
        field.build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let whole = Type::group_type_builder(shape.name).with_fields(fields);
    whole.build().map(Arc::new)
}

/// Writes one column: the existing values, and for every row a definition level that says whether its value
/// exists.
fn column<T: DataType>(
    writer: &mut SerializedColumnWriter<'_>,
    fields: &[Option<T::T>],
) -> Result<(), ParquetError> {
    let there: Vec<i16> = fields.iter().map(|f| i16::from(f.is_some())).collect();
    let values: Vec<T::T> = fields.iter().flatten().cloned().collect();
    writer
        .typed::<T>()
        .write_batch(&values, Some(&there), None)?;
    Ok(())
}

fn group(
    writer: &mut SerializedFileWriter<File>,
    kinds: &[Kind],
    rows: &[Vec<Value>],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (place, kind) in kinds.iter().enumerate() {
        let Some(mut to) = group.next_column()? else {
            break;
        };
        let fields = rows.iter().map(|row| row.get(place));
        match kind {
            Kind::Integer => {
                let number = |field: Option<&Value>| match field {
                    Some(Value::Integer(number)) => Some(*number),
                    Some(Value::Null | Value::Real(_) | Value::Text(_)) | None => None,
                };
                column::<Int64Type>(&mut to, &fields.map(number).collect::<Vec<_>>())?;
            }
            Kind::Real => {
                let number = |field: Option<&Value>| match field {
                    Some(Value::Real(number)) => Some(*number),
                    Some(Value::Null | Value::Integer(_) | Value::Text(_)) | None => None,
                };
                column::<DoubleType>(&mut to, &fields.map(number).collect::<Vec<_>>())?;
            }
            Kind::Text => {
                let text = |field: Option<&Value>| match field {
                    Some(Value::Text(text)) => Some(ByteArray::from(text.as_str())),
                    Some(Value::Null | Value::Integer(_) | Value::Real(_)) | None => None,
                };
                column::<ByteArrayType>(&mut to, &fields.map(text).collect::<Vec<_>>())?;
            }
        }
        to.close()?;
    }
    group.close()?;
    Ok(())
}

impl Sink for ParquetFiles {
    fn begin(&mut self, shape: &Schema) -> Result<(), StoreError> {
        let path = self.folder.join(format!("{}.parquet", shape.name));
        let failed = |error| StoreError::table(&path, error);
        let file = File::create(&path).map_err(StoreError::writing(&path))?;
        let properties = Arc::new(WriterProperties::builder().build());
        let schema = schema(shape).map_err(failed)?;
        let writer = SerializedFileWriter::new(file, schema, properties).map_err(failed)?;
        let kinds = shape.columns.iter().map(|column| column.kind).collect();
        self.files.push((path, kinds, writer));
        Ok(())
    }

    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError> {
        let Some((path, kinds, writer)) = self.files.get_mut(place) else {
            return Ok(());
        };
        group(writer, kinds, rows).map_err(|error| StoreError::table(path, error))
    }

    fn finish(self: Box<Self>) -> Result<(), StoreError> {
        for (path, _, mut writer) in self.files {
            writer
                .finish()
                .map_err(|error| StoreError::table(&path, error))?;
            let synced = writer.inner().sync_all();
            synced.map_err(StoreError::writing(&path))?;
        }
        Ok(())
    }
}
