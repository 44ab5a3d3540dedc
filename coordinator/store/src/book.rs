//! Tables on their way to files: rows are gathered and handed on by the thousand, so that an export
//! needs no more memory for a million results than for ten thousand.
use super::{
    column::{Column, Columns, Value},
    error::StoreError,
};
use std::{collections::BTreeMap, mem};

/// Rows of a table that are handed on at a time.
const ROWS: usize = 4096;

/// A table as a writer sees it.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) name: &'static str,
    pub(super) columns: Vec<Column>,
}

/// Writes tables in one form.
pub(super) trait Sink {
    /// Begins the next table.
    fn begin(&mut self, shape: &Shape) -> Result<(), StoreError>;

    /// Writes rows of the table that was begun as the `place`-th, from 0.
    fn write(&mut self, place: usize, rows: &[Vec<Value>]) -> Result<(), StoreError>;

    /// Completes all files.
    fn finish(self: Box<Self>) -> Result<(), StoreError>;
}

/// A table that was begun.
pub(super) struct Table<R> {
    place: usize,
    columns: Columns<R>,
}

/// All tables of an export.
pub(super) struct Book {
    sink: Box<dyn Sink>,
    pages: Vec<Page>,
}

struct Page {
    shape: Shape,
    waiting: Vec<Vec<Value>>,
    rows: u64,
}

impl Book {
    pub(super) fn new(sink: Box<dyn Sink>) -> Self {
        Self {
            sink,
            pages: Vec::new(),
        }
    }

    /// Begins a table.
    pub(super) fn begin<R: 'static>(
        &mut self,
        name: &'static str,
        columns: Columns<R>,
    ) -> Result<Table<R>, StoreError> {
        let shape = Shape {
            name,
            columns: columns.columns().to_vec(),
        };
        self.sink.begin(&shape)?;
        self.pages.push(Page {
            shape,
            waiting: Vec::new(),
            rows: 0,
        });
        Ok(Table {
            place: self.pages.len() - 1,
            columns,
        })
    }

    /// Adds a row.
    pub(super) fn put<R: 'static>(&mut self, to: &Table<R>, row: &R) -> Result<(), StoreError> {
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

    /// What every table looks like.
    pub(super) fn shapes(&self) -> Vec<Shape> {
        self.pages.iter().map(|page| page.shape.clone()).collect()
    }

    /// Hands on what waits and completes all files; how many rows each table has.
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
