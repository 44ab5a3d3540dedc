//! Which unknowns the record sees apart, and which only together.
use crate::report::document::{Section, tables};
use crate::report::identification::{subject::Subject, table};

pub(super) fn section(subject: &Subject<'_>) -> Section {
    Section {
        id: "apart",
        title: "What it sees apart, and what only together",
        blocks: tables(table::directions(subject)),
    }
}
