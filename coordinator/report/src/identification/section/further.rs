//! What further measurements would tell.
use crate::document::{Section, tables};
use crate::identification::{subject::Subject, table};

pub(super) fn section(subject: &Subject<'_>) -> Section {
    Section {
        id: "further",
        title: "What would tell more",
        blocks: tables(table::further(subject)),
    }
}
