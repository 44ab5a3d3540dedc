//! Report section on the reliability of the verdict: numerical error, noise, convergence, parameters and
//! cost.
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::table as tables;
use crate::document::{Block, Fact, Section};
use crate::number::{percent, significant};

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut blocks = Vec::new();
    let facts = facts(subject);
    if !facts.is_empty() {
        blocks.push(Block::Facts(facts));
        blocks.push(tables::numerics(subject).map_or_else(
            || {
                Block::Text(
                    "The finer model of the numerical check did not complete: how far the \
                     discretisation moves the curves is not known."
                        .to_owned(),
                )
            },
            Block::Table,
        ));
        let rest = [
            tables::instruments(subject),
            tables::genes(subject),
            tables::stages(subject),
        ];
        blocks.extend(rest.into_iter().flatten().map(Block::Table));
    }
    Section {
        id: "certainty",
        title: "Reliability of the verdict",
        blocks,
    }
}

/// Lists facts about the noise, the convergence of the recalibration and the dispersion of the recalibrated
/// model's residual; empty if the recalibration did not finish.
fn facts(subject: &DiagnosisInput<'_>) -> Vec<Fact> {
    let diagnosis = subject.diagnosis();
    let Some(fit) = &diagnosis.before else {
        return Vec::new();
    };
    let noise = if diagnosis.noise.is_seen() {
        "seen: the scatter between the cycles, order by order"
    } else {
        "as stated by the case or the data sheet, and seen in the highest orders: there was one cycle"
    };
    let recalibration = format!(
        "one more step promises to lower the misfit by {}; the tests look at the residual after that \
         step",
        percent(fit.predicted_decrease)
    );
    let mut facts = vec![
        Fact::new("noise", noise),
        Fact::new("recalibration", recalibration),
    ];
    let after = diagnosis.after.iter();
    facts.extend(after.filter(|after| !after.added.is_empty()).map(|after| {
        let promised = percent(after.predicted_decrease);
        Fact::new("fit with the answer", format!("the same: {promised}"))
    }));
    facts.extend(diagnosis.rounds.first().map(|round| {
        let left = format!(
            "{} by the best model, per degree of freedom; intervals are as many times as wide",
            significant(round.dispersion.sqrt())
        );
        Fact::new("times the noise", left)
    }));
    facts
}
