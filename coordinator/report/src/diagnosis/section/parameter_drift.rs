//! Report section on parameters that would have to vary along the record or between conditions, for the model
//! before and after the added effects.
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::table::{self as tables, VariationUnderModel};
use crate::document::{Block, Section};

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    Section {
        id: "wander",
        title: "Parameters that would have to wander",
        blocks: blocks(subject),
    }
}

fn blocks(subject: &DiagnosisInput<'_>) -> Vec<Block> {
    let diagnosis = subject.diagnosis();
    let models = [
        (
            "The recalibrated model",
            &diagnosis.before,
            &diagnosis.drifts,
        ),
        ("With the answer", &diagnosis.after, &diagnosis.drifts_after),
    ];
    let models = models.map(|(title, fit, wander)| {
        let fit = fit.as_ref().filter(|_| !wander.is_empty())?;
        Some(VariationUnderModel { title, fit, wander })
    });
    let [Some(before), after] = models else {
        return Vec::new();
    };
    let mut blocks = vec![Block::Text(
        "A parameter is the same everywhere along a record and under every condition. One that would \
         have to change from part to part makes up for something that the model lacks."
            .to_owned(),
    )];
    let none = [
        "With the recalibrated model none would have to, within the scatter between cycles.",
        "With the answer none would have to, within the scatter between cycles.",
    ];
    for (model, none) in std::iter::once(before).chain(after).zip(none) {
        blocks.push(
            tables::wander(subject, &model)
                .map_or_else(|| Block::Text(none.to_owned()), Block::Table),
        );
    }
    blocks
}
