//! Buffered output of tables: rows are collected and passed to the writer in batches, so that the memory of
//! an export does not grow with the number of results.
use super::{
    column::{Column, Columns, Value},
    error::StoreError,
};
use std::{collections::BTreeMap, mem};

/// Number of rows of a table that are collected before they are written as one batch.
const ROWS: usize = 4096;

/// Schema of an exported table: its name and columns.
#[derive(Clone, Debug)]
pub(super) struct Schema {
    pub(super) name: &'static str,
    pub(super) columns: Vec<Column>,
}

/// Writer of tables in one file format (SQLite, CSV or Parquet).
pub(super) trait Sink {
    /// Begins a table with the given name and columns; tables are counted in the order in which they are
    /// begun.
    fn begin(&mut self, shape: &Schema) -> Result<(), StoreError>;

    /// Writes rows of the table with index `place`; tables are counted from 0 in the order in which they were
    /// begun.
    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError>;

    /// Completes and closes all files of the export.
    fn finish(self: Box<Self>) -> Result<(), StoreError>;
}

/// Handle by which rows are added to one table of an export; each row is made from a value of type `R`.
pub(super) struct TableHandle<R> {
    place: usize,
    columns: Columns<R>,
}

/// Buffering writer of an export: collects the rows of each table and passes full batches to the format's
/// writer.
pub(super) struct TableWriter {
    sink: Box<dyn Sink>,
    pages: Vec<TableBuffer>,
}

struct TableBuffer {
    shape: Schema,
    waiting: Vec<Vec<Value>>,
    rows: u64,
}

impl TableWriter {
    pub(super) fn new(sink: Box<dyn Sink>) -> Self {
        Self {
            sink,
            pages: Vec::new(),
        }
    }

    /// Begins a table of the export and returns the handle for adding rows to it.
    pub(super) fn begin<R: 'static>(
        &mut self,
        name: &'static str,
        columns: Columns<R>,
    ) -> Result<TableHandle<R>, StoreError> {
        let shape = Schema {
            name,
            columns: columns.columns().to_vec(),
        };
        self.sink.begin(&shape)?;
        self.pages.push(TableBuffer {
            shape,
            waiting: Vec::new(),
            rows: 0,
        });
        Ok(TableHandle {
            place: self.pages.len() - 1,
            columns,
        })
    }

    /// Adds a row to a table, and writes the table's batch of rows once it is full.
    pub(super) fn add_row<R: 'static>(
        &mut self,
        to: &TableHandle<R>,
        row: &R,
    ) -> Result<(), StoreError> {
        let Some(page) = self.pages.get_mut(to.place) else {
            return Ok(());
        };
        page.waiting.push(to.columns.fields(row));
        page.rows += 1;
        if page.waiting.len() < ROWS {
            return Ok(());
        }
        self.sink.write(to.place, &mem::take(&mut page.waiting))
    }

    pub(super) fn schemas(&self) -> Vec<Schema> {
        self.pages.iter().map(|page| page.shape.clone()).collect()
    }

    /// Writes all remaining rows, completes the export's files, and returns the number of rows by table name.
    pub(super) fn finish(mut self) -> Result<BTreeMap<&'static str, u64>, StoreError> {
        let mut rows = BTreeMap::new();
        for (place, page) in self.pages.iter_mut().enumerate() {
            if !page.waiting.is_empty() {
                self.sink.write(place, &mem::take(&mut page.waiting))?;
            }
            rows.insert(page.shape.name, page.rows);
        }
        self.sink.finish()?;
        Ok(rows)
    }
}
