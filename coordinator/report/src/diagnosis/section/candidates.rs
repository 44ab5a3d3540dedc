//! Report section on the candidate effects: each with its test, its refit and the reason why it was kept or
//! dropped.
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::{table as tables, words};
use crate::document::{Block, Section};
use discrepancy::diagnose::Round;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let rounds = &subject.diagnosis().rounds;
    Section {
        id: "what",
        title: "Candidate effects",
        blocks: if rounds.is_empty() {
            Vec::new()
        } else {
            blocks(subject)
        },
    }
}

/// Returns whether two rounds belong to one step that added several effects jointly, that is, have identical
/// test statistics.
fn is_same_joint_step(one: &Round, other: &Round) -> bool {
    let statistics = |round: &Round| -> Vec<u64> {
        let all = round.candidates.iter();
        all.map(|own| own.statistic().to_bits()).collect()
    };
    one.together && other.together && statistics(one) == statistics(other)
}

fn blocks(subject: &DiagnosisInput<'_>) -> Vec<Block> {
    let diagnosis = subject.diagnosis();
    let mut blocks = vec![Block::Text(
        "Each effect of the library was switched on at the recalibrated point, its signature projected \
         off what recalibration can absorb, and tested on what the model leaves; the likeliest were \
         then fitted for real, with every gene free."
            .to_owned(),
    )];
    let mut before: Option<&Round> = None;
    for (number, round) in (1..).zip(&diagnosis.rounds) {
        // several effects that were found together stand in one table
        if before.is_none_or(|before| !is_same_joint_step(before, round)) {
            blocks.push(Block::Table(tables::candidate_effects(number, round)));
        }
        before = Some(round);
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
            "The best explanation by a wide margin is {force}: no named effect comes close."
        )));
    } else if let Some(force) = &diagnosis.force {
        let force = words::generic(subject, &force.id);
        blocks.push(Block::Text(format!(
            "The best explanation is {force}, but it is not confirmed."
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
