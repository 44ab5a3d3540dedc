//! Report section with the outcome of a calibration in words: change of the error by condition and channel.
use super::machine;
use crate::chart;
use crate::data::{Calibration, SingleRun};
use crate::document::{Block, Section, figures};
use crate::kind;
use crate::machine_check::MachineCheck;
use crate::number::significant;
use crate::words;

/// Builds the first screen: the change of the objective in one sentence, the fitted channels before and after, and
/// what the fit leaves.
pub(super) fn calibration(calibration: &Calibration) -> Section {
    let checks = machine::checks(calibration);
    let mut blocks = headline(calibration, &checks);
    let fitted = calibration.calibrated();
    blocks.extend(figures(
        fitted.and_then(|result| chart::fitted(&calibration.case, result)),
    ));
    blocks.extend(machine::blocks(&checks, ["recommended", "optimised"]));
    blocks.extend(words::rivals(calibration).map(|said| Block::Warning(vec![said])));
    blocks.extend(words::model_error(calibration).map(|said| Block::Warning(vec![said])));
    blocks.extend(words::noise_level(calibration).map(Block::Text));
    if calibration.origin.synthetic {
        blocks.push(Block::Text(words::SYNTHETIC.to_owned()));
    }
    section(blocks)
}

/// Builds the first section of a calibration that goes on: the agreement of the best individual so far.
pub(super) fn running(calibration: &Calibration) -> Section {
    let checks = machine::checks(calibration);
    let lead = words::agreement(calibration, &checks).map(Block::Lead);
    let mut blocks: Vec<Block> = lead.into_iter().collect();
    blocks.extend(machine::blocks(&checks, ["recommended", "best"]));
    section(blocks)
}

/// Returns the change of the fit in an engineer's quantities, then that of the objective; the latter alone where the
/// former cannot be told.
pub(crate) fn headline(calibration: &Calibration, checks: &[MachineCheck]) -> Vec<Block> {
    let objective = words::headline(calibration);
    match words::agreement(calibration, checks) {
        Some(agreement) => vec![Block::Lead(agreement), Block::Text(objective)],
        None => vec![Block::Lead(objective)],
    }
}

/// Builds the section on what changed: the errors by condition and channel, and warnings.
pub(super) fn changes(calibration: &Calibration) -> Section {
    let mut blocks = conditions(calibration);
    let warnings = words::warnings(calibration);
    if !warnings.is_empty() {
        blocks.push(Block::Warning(warnings));
    }
    Section {
        id: "changes",
        title: "What changed",
        blocks,
    }
}

/// Describes the change of each channel's error, by condition.
fn conditions(calibration: &Calibration) -> Vec<Block> {
    let case = &calibration.case;
    let mut blocks = Vec::new();
    for result in &calibration.conditions {
        let name = words::condition_name(case, result.condition);
        let role = if case.objective.holds(result.condition) {
            "calibrated"
        } else {
            "took no part in the fit"
        };
        blocks.push(Block::Heading(format!("Condition {name}"), role));
        let sentences = words::channels(case, result);
        blocks.push(if sentences.is_empty() {
            let none = "There are no scores under this condition: no record, or no complete run.";
            Block::Text(none.to_owned())
        } else {
            Block::List(sentences)
        });
        blocks.extend(words::absolute_worse(case, result).map(Block::Text));
    }
    blocks
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let mut blocks = vec![Block::Lead(format!(
        "Condition {} with the {} parameters: {}.",
        words::condition_name(&run.case, run.condition),
        run.genes_name,
        words::verdict(&run.curves.verdict)
    ))];
    let warning = kind::of(&run.case).warning(run);
    blocks.extend(warning.map(|said| Block::Warning(vec![said])));
    if let Some(evaluation) = &run.evaluation {
        if run.origin.synthetic {
            blocks.push(Block::Text(words::SYNTHETIC.to_owned()));
        }
        blocks.push(Block::Text(if evaluation.channels.is_empty() {
            "There is no score: no record, or no complete run.".to_owned()
        } else {
            let unit = words::square_after(run.case.objective_unit());
            format!(
                "The objective is {}{unit}.",
                significant(evaluation.fitness)
            )
        }));
    }
    section(blocks)
}

const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "summary",
        title: "Summary",
        blocks,
    }
}
