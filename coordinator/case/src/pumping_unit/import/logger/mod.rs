//! Tables of data loggers and other programs, as they are exported: any delimiter, decimal sign and encoding,
//! lines before the header, a line of units, words for missing values, lines after the data.
//!
//! [`sniff`] proposes the [`Layout`] of a file from its content; [`read`] reads the requested columns of a
//! file of a given layout. A file is read line by line and never written.
mod clock;
mod columns;
mod layout;
mod lines;
mod read;
mod sniff;
mod unit;

pub(super) use clock::{Time, propose as propose_time};
pub(super) use columns::{Columns, Quantity};
pub(super) use layout::Layout;
pub(super) use lines::content;
pub(super) use read::{Table, read, survey};
pub(super) use sniff::{Sample, sniff};
pub(super) use unit::{factor, normal};
