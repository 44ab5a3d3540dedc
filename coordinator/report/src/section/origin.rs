//! Report section on provenance: everything needed to reproduce a result and to compare it.
use crate::data::{Calibration, Origin, SingleRun};
use crate::document::{Block, Fact, Section};
use crate::number::{MISSING, count, duration};
use crate::words::{calibrated, join_words};
use protocol::case::{Case, Channel};
use protocol::job::Curves;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let optimum = calibration.optimised.id;
    let mut facts = facts(&calibration.origin, &calibration.case);
    facts.extend([
        Fact::new("objective", objective(&calibration.case)),
        Fact::new(
            "optimum",
            optimum.map_or_else(
                || MISSING.to_owned(),
                |id| format!("individual {}", count(id)),
            ),
        ),
        Fact::new("wall time", duration(calibration.wall_s)),
        Fact::code("digest of the evaluation log", &calibration.origin.digest),
    ]);
    let mut blocks = vec![Block::Facts(facts)];
    let result = calibration.calibrated();
    blocks.extend(result.map(|result| work(&result.optimised.curves)));
    section(blocks)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let mut facts = facts(&run.origin, &run.case);
    facts.push(Fact::code("digest of the result", &run.origin.digest));
    section(vec![Block::Facts(facts), work(&run.curves)])
}

/// Creates the provenance section shared by all reports.
pub(crate) const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "provenance",
        title: "How it was made",
        blocks,
    }
}

/// Lists the provenance facts common to all results: program, command, run, case, digests, preset and seed.
pub(crate) fn facts(origin: &Origin, case: &Case) -> Vec<Fact> {
    let mut facts = vec![
        Fact::new("program", &origin.program),
        Fact::code("command", &origin.command),
        Fact::new("run", &origin.run),
        Fact::new("case", &case.name),
        Fact::code("digest of the case", &origin.case_hash),
        Fact::new("measured records", &origin.measured_name),
    ];
    let preset = origin.preset.iter();
    facts.extend(preset.map(|preset| Fact::new("preset", preset)));
    let seed = origin.seed.iter();
    facts.extend(seed.map(|seed| Fact::new("seed", seed.to_string())));
    facts
}

/// Describes the objective: its terms, conditions and the treatment of offsets.
fn objective(case: &Case) -> String {
    let terms = case.objective.terms.iter();
    let terms: Vec<_> = terms
        .map(|term| format!("{} × MSE of {}", term.weight, term.channel))
        .collect();
    let is_summed = |channel: &&Channel| case.objective.names(&channel.name);
    let summed = case.channels.iter().filter(is_summed);
    let mut fixed: Vec<String> = summed
        .clone()
        .filter(|channel| channel.is_absolute())
        .map(|channel| channel.name.clone())
        .collect();
    fixed.sort_unstable();
    fixed.dedup();
    let offset = if fixed.is_empty() {
        "free: the mean difference of each channel is removed first".to_owned()
    } else if summed.clone().all(Channel::is_absolute) {
        "fixed: absolute values are compared".to_owned()
    } else {
        let fixed = join_words(&fixed, "and");
        format!("fixed for {fixed}, free for the others: their mean difference is removed first")
    };
    let conditions = match case.objective.others.len() {
        0 => String::new(),
        _ => format!(", summed over {}", calibrated(case)),
    };
    format!("{}{conditions}; offset {offset}", terms.join(" + "))
}

/// Describes the integrator's work and the wall time of one simulation.
fn work(curves: &Curves) -> Block {
    let counters = curves.counters.labelled();
    let counted = counters.map(|(_, what, number)| format!("{} {what}", count(number)));
    Block::Text(format!(
        "One simulation with these parameters took {}, in {} on its worker.",
        join_words(&counted, "and"),
        duration(curves.wall_s)
    ))
}
