//! Sections of the identification report, in page order.
use super::subject::IdentificationInput;
use crate::document::{Block, Fact, Section, figures, tables};
use crate::identification::{chart, table, words};
use crate::number::duration;
use crate::section::origin as shared;
use crate::words::SYNTHETIC;

/// All sections of the identification report, in page order.
pub(super) const SECTIONS: &[fn(&IdentificationInput<'_>) -> Section] =
    &[seen, directions, prediction, proposals, origin];

fn seen(subject: &IdentificationInput<'_>) -> Section {
    let mut blocks = vec![
        Block::Lead(words::lead(subject)),
        Block::List(words::grounds(subject)),
        Block::Table(table::unknowns(subject)),
    ];
    if subject.identified.has_intervals {
        blocks.push(Block::Figure(chart::profiles(subject)));
    }
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
        title: "Unknowns that the record determines",
        blocks,
    }
}

fn directions(subject: &IdentificationInput<'_>) -> Section {
    Section {
        id: "apart",
        title: "Directions that the record determines",
        blocks: tables(table::directions(subject)),
    }
}

fn prediction(subject: &IdentificationInput<'_>) -> Section {
    let mut blocks = tables(table::prediction(subject));
    blocks.extend(figures(chart::bands(subject)));
    Section {
        id: "prediction",
        title: "Uncertainty of predictions",
        blocks,
    }
}

fn proposals(subject: &IdentificationInput<'_>) -> Section {
    Section {
        id: "further",
        title: "Proposed further measurements",
        blocks: tables(table::further(subject)),
    }
}

fn origin(subject: &IdentificationInput<'_>) -> Section {
    let mut facts = shared::facts(&subject.origin, subject.case);
    facts.push(Fact::new("wall time", duration(subject.wall_s)));
    shared::section(vec![Block::Facts(facts)])
}
