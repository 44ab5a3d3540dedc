//! Which unknowns the record sees, and what that rests on.
use crate::document::{Block, Section};
use crate::identification::{chart, subject::Subject, table, words};
use crate::words::SYNTHETIC;

pub(super) fn section(subject: &Subject<'_>) -> Section {
    let mut blocks = vec![
        Block::Lead(words::lead(subject)),
        Block::List(words::grounds(subject)),
        Block::Table(table::unknowns(subject)),
        Block::Figure(chart::profiles(subject)),
    ];
    if subject.origin.synthetic {
        blocks.push(Block::Text(SYNTHETIC.to_owned()));
    }
    let notes = subject.identified.notes.iter().chain(subject.notes);
    let notes: Vec<String> = notes.cloned().collect();
    if !notes.is_empty() {
        blocks.push(Block::Warning(notes));
    }
    Section {
        id: "seen",
        title: "What the record sees",
        blocks,
    }
}
