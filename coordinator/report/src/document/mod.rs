//! Document model of reports and its output formats: a list of sections made of blocks, rendered as an HTML
//! page, plain text and a folder of figures.
//!
//! Independent of calibrations and diagnoses, and of the content of tables and figures.
mod block;
mod figure;
mod page;
mod table;
mod text;

pub use block::{Block, Report, Section};
pub use block::{Fact, figures, tables};
pub use figure::Figure;
pub(super) use page::SCRIPT;
pub use page::{GENERATOR, STYLE, page, section_markup};
pub use table::Row;
pub use table::Table;
pub use text::TerminalStyle;
pub(super) use text::section_text;
pub use text::{set_table, text};
