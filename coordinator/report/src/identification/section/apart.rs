//! Which unknowns the record sees apart, and which only together.
use crate::document::{Section, tables};
use crate::identification::{subject::Subject, table};

pub(super) fn section(subject: &Subject<'_>) -> Section {
    Section {
        id: "apart",
        title: "What it sees apart, and what only together",
        blocks: tables(table::directions(subject)),
    }
}
