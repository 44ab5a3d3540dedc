//! A run as tables for queries, built from its journal: SQLite, CSV or Parquet.
//!
//! [`Store`] folds the journal into rows; what was *asked* stands in no journal, so whoever repeats
//! the run's study on the recording ([`study::Recorded`]) hands in the simulations one by
//! one. Rows stream: neither curves nor residuals nor tables are held in memory. The journal is the
//! truth and is never changed; an export can always be made again, with the same content.
mod book;
mod column;
mod csv;
mod error;
mod export;
mod parquet;
#[cfg(test)]
mod read_back;
mod row;
mod sqlite;
mod table;
mod target;
#[cfg(test)]
mod tests;

pub use error::StoreError;
pub use export::{Exported, Label, Store};
pub use table::gene_column;
pub use target::{Format, Target};

// tests of other crates include what reads exports back
#[cfg(test)]
extern crate self as store;
