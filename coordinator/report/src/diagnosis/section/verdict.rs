//! Report section with the verdict: one sentence, the effect sizes, the confidence and the recommended next
//! steps.
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::words;
use crate::document::{Block, Section};
use crate::words::SYNTHETIC;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let diagnosis = subject.diagnosis();
    let mut blocks = vec![Block::Lead(words::verdict(subject))];
    let reason = diagnosis.reason.iter();
    blocks.extend(reason.map(|reason| Block::Text(format!("The reason: {reason}."))));
    let effects = words::effects(subject);
    if !effects.is_empty() {
        blocks.push(Block::List(effects));
    }
    let grounds = words::confidence(subject);
    if !grounds.is_empty() {
        blocks.extend([
            Block::Heading("How sure".to_owned(), ""),
            Block::List(grounds),
        ]);
    }
    blocks.extend([
        Block::Heading("What to do next".to_owned(), ""),
        Block::List(words::next(subject)),
    ]);
    if subject.origin.synthetic {
        blocks.push(Block::Text(SYNTHETIC.to_owned()));
    }
    let notes = diagnosis.notes.iter().chain(subject.notes);
    let notes: Vec<String> = notes.cloned().collect();
    if !notes.is_empty() {
        blocks.push(Block::Warning(notes));
    }
    Section {
        id: "verdict",
        title: "Verdict",
        blocks,
    }
}
