//! Report section on the effects added to the model: their estimated sizes and the entry for the case file.
use crate::diagnosis::effects::effects_toml;
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::table as tables;
use crate::document::{Block, Section};

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut blocks: Vec<Block> = tables::sizes(subject)
        .map(Block::Table)
        .into_iter()
        .collect();
    if let Some(entry) = effects_toml(subject) {
        blocks.extend([
            Block::Text(
                "The same as an entry of the case's model file. Without it the model is what it was, \
                 to the bit; with it the effect is ordinary physics, simulated by every worker and \
                 fitted like any gene:"
                    .to_owned(),
            ),
            Block::Code(entry),
        ]);
    }
    Section {
        id: "add",
        title: "Effects added to the model",
        blocks,
    }
}
