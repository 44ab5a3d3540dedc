//! What a report is made of, and its forms: one list of sections with their blocks, which the page,
//! the plain text and the folder of figures are folds over.
//!
//! Knows neither calibrations nor diagnoses, nor what a table or a figure shows.
mod block;
mod figure;
mod page;
mod table;
mod text;

pub use block::{Block, Report, Section};
pub use block::{Fact, figures, tables};
pub use figure::Figure;
pub use page::page;
pub use table::Row;
pub use table::Table;
pub(super) use text::section_text;
pub use text::{set_table, text};
