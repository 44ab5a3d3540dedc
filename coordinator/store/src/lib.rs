//! Export of a run as tables for queries, built from its journal: SQLite, CSV or Parquet.
//!
//! [`Store`] converts the journal into rows. Rows are streamed: neither curves nor residuals nor tables are held
//! in memory. The journal is authoritative and never changed; an export can be repeated at any time with
//! identical content.
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
mod writer;

pub use error::StoreError;
pub use export::{Contents, Exported, Store};
pub use table::gene_column;
pub use target::{Format, Target};

// tests of other crates include what reads exports back
#[cfg(test)]
extern crate self as store;
