//! What the answer predicts, and how far the record leaves that open.
use crate::document::{Section, figures, tables};
use crate::identification::{chart, subject::Subject, table};

pub(super) fn section(subject: &Subject<'_>) -> Section {
    let mut blocks = tables(table::prediction(subject));
    blocks.extend(figures(chart::bands(subject)));
    Section {
        id: "prediction",
        title: "What it leaves open in predictions",
        blocks,
    }
}
