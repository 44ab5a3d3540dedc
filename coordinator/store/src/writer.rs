//! Buffered output of tables: rows are collected and passed to the writer in batches, so that the memory of
//! an export does not grow with the number of results.
use super::{
    column::{Column, Columns, Value},
    error::StoreError,
};
use std::{collections::BTreeMap, mem};

/// Number of rows per batch of a table.
const ROWS: usize = 4096;

/// Schema of a table: name and columns.
#[derive(Clone, Debug)]
pub(super) struct Schema {
    pub(super) name: &'static str,
    pub(super) columns: Vec<Column>,
}

/// Writer of tables in one file format.
pub(super) trait Sink {
    /// Begins the next table.
    fn begin(&mut self, shape: &Schema) -> Result<(), StoreError>;

    /// Writes rows of the table with index `place`; tables are counted from 0 in the order in which they were
    /// begun.
    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError>;

    /// Completes and closes all files.
    fn finish(self: Box<Self>) -> Result<(), StoreError>;
}

/// Handle of a table in an export; each of its rows is made from a value of type `R`.
pub(super) struct TableHandle<R> {
    place: usize,
    columns: Columns<R>,
}

/// Tables of an export with their buffered rows and their writer.
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

    /// Begins a table and returns its handle.
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

    /// Adds a row, and writes the batch once it is full.
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

    /// Returns the schemas of all tables.
    pub(super) fn schemas(&self) -> Vec<Schema> {
        self.pages.iter().map(|page| page.shape.clone()).collect()
    }

    /// Writes the remaining rows, completes all files, and returns the number of rows of each table.
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
