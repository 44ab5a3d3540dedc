//! Tables of results, one file per subject: their content, not their layout.
mod compare;
mod single;

pub use super::document::Row;
pub use super::document::{Table, set_table as text};
pub use compare::{rivals, table_3, table_4};
pub(super) use single::genes;
pub use single::{agreement, range_row, ranges, simulation, value_row, value_table, work};
