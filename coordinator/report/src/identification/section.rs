//! Sections of an identification's report, in the order of the page.
use super::subject::Subject;
use crate::document::{Block, Fact, Section, figures, tables};
use crate::identification::{chart, table, words};
use crate::number::duration;
use crate::section::origin as shared;
use crate::words::SYNTHETIC;

/// Every section, in the order of the page.
pub(super) const SECTIONS: &[fn(&Subject<'_>) -> Section] =
    &[seen, apart, prediction, further, origin];

fn seen(subject: &Subject<'_>) -> Section {
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

fn apart(subject: &Subject<'_>) -> Section {
    Section {
        id: "apart",
        title: "What it sees apart, and what only together",
        blocks: tables(table::directions(subject)),
    }
}

fn prediction(subject: &Subject<'_>) -> Section {
    let mut blocks = tables(table::prediction(subject));
    blocks.extend(figures(chart::bands(subject)));
    Section {
        id: "prediction",
        title: "What it leaves open in predictions",
        blocks,
    }
}

fn further(subject: &Subject<'_>) -> Section {
    Section {
        id: "further",
        title: "What would tell more",
        blocks: tables(table::further(subject)),
    }
}

fn origin(subject: &Subject<'_>) -> Section {
    let mut facts = shared::facts(&subject.origin, subject.case);
    facts.push(Fact::new("wall time", duration(subject.wall_s)));
    shared::section(vec![Block::Facts(facts)])
}
