//! What was suspected: every effect with its test, its refit, and why it was dropped or kept.
use crate::report::diagnosis::subject::Subject;
use crate::report::diagnosis::{table as tables, words};
use crate::report::document::{Block, Section};

pub(super) fn section(subject: &Subject<'_>) -> Section {
    let rounds = &subject.diagnosis().rounds;
    Section {
        id: "what",
        title: "What was suspected",
        blocks: if rounds.is_empty() {
            Vec::new()
        } else {
            blocks(subject)
        },
    }
}

fn blocks(subject: &Subject<'_>) -> Vec<Block> {
    let diagnosis = subject.diagnosis();
    let mut blocks = vec![Block::Text(
        "Each effect of the library was switched on at the recalibrated point, its signature projected \
         off what recalibration can absorb, and tested on what the model leaves; the likeliest were \
         then fitted for real, with every gene free."
            .to_owned(),
    )];
    for (number, round) in (1..).zip(&diagnosis.rounds) {
        blocks.push(Block::Table(tables::suspects(number, round)));
        blocks.extend(round.reason.as_ref().map(|reason| {
            Block::Text(format!(
                "No effect of this round is in the answer: {reason}."
            ))
        }));
    }
    let generics = diagnosis.rounds.first().and_then(tables::generics);
    blocks.extend(generics.map(Block::Table));
    if let Some(id) = &diagnosis.generic {
        let force = words::generic(subject, id);
        blocks.push(Block::Text(format!(
            "The widest margin has {force}: no name comes near it."
        )));
    } else if let Some(force) = &diagnosis.force {
        let force = words::generic(subject, &force.id);
        blocks.push(Block::Text(format!(
            "The widest margin has {force}, and it is only suspected."
        )));
    }
    blocks.extend(tables::absorbed(subject).map(Block::Table));
    blocks.extend(tables::look_alikes(subject).map(Block::Table));
    let limits = tables::limits(subject).map(Block::Table);
    blocks.extend(
        limits.map(|limits| Block::Folded("Detection limits of all effects", vec![limits])),
    );
    blocks
}
