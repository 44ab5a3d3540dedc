//! Reports of sweeps over the content of a file: a grid of settings, or a table of individuals.
use crate::data::Origin;
use crate::document::{Block, Report, Row, Section, Table};
use crate::number::{MISSING, count, significant};
use crate::orthogonal::{level_names, runs};
use crate::section::origin;
use crate::words::{SYNTHETIC, objective_heading, square_after, verdict, with_unit};
use protocol::{case::Case, job::Verdict};
use study::{
    Scored,
    orthogonal::{Factor, TrialRun},
};

/// Maximum number of individuals that a page lists, the best first.
const MOST: usize = 1000;

/// Builds the report of the searches of a grid.
pub fn grid(case: &Case, origin: &Origin, factors: &[Factor], tried: &[TrialRun]) -> Report {
    let complete = tried
        .iter()
        .filter_map(|run| Some((run, run.objective.filter(|own| own.is_finite())?)));
    let best = complete.min_by(|(_, a), (_, b)| a.total_cmp(b));
    let lead = match best {
        Some((run, objective)) => format!(
            "The best of {} searches reached an objective of {}: {}, seed {}.",
            count(tried.len() as u64),
            objective_words(case, objective),
            level_names(factors, &run.levels),
            run.seed
        ),
        None => "No search found a complete simulation.".to_owned(),
    };
    let table = runs(case, factors, tried);
    let title = format!("Searches of a grid on {}", case.name);
    page(title, (case, origin), lead, table)
}

/// Builds the report of the individuals of a table; `names` are the unknowns of its columns, `rows` their values in
/// declared units.
pub fn individuals(
    case: &Case,
    origin: &Origin,
    (names, rows, scores): (&[String], &[Vec<f64>], &[Scored]),
) -> Report {
    let mut all: Vec<(usize, &Vec<f64>, &Scored)> = rows
        .iter()
        .zip(scores)
        .enumerate()
        .map(|(place, (row, scored))| (place + 1, row, scored))
        .collect();
    let is_complete = |scored: &Scored| {
        scored
            .as_ref()
            .is_ok_and(|own| own.verdict == Verdict::Complete && own.fitness.is_finite())
    };
    let order = |scored: &Scored| match scored {
        Ok(own) => (u8::from(!is_complete(scored)), own.fitness),
        Err(_) => (2, f64::INFINITY),
    };
    all.sort_by(|(_, _, a), (_, _, b)| {
        let ((own, x), (other, y)) = (order(a), order(b));
        own.cmp(&other).then(x.total_cmp(&y))
    });
    let complete = all.iter().filter(|(_, _, own)| is_complete(own)).count();
    let lead = match all.first() {
        Some((place, _, Ok(best))) if complete > 0 => format!(
            "{} of {} individuals completed their simulation; the best, row {place} of the table, has an objective \
             of {}.",
            count(complete as u64),
            count(all.len() as u64),
            objective_words(case, best.fitness)
        ),
        Some(_) | None => "No individual completed its simulation.".to_owned(),
    };
    let row = |(place, row, scored): &(usize, &Vec<f64>, &Scored)| {
        let (objective, ending) = match scored {
            Ok(own) => (
                is_complete(scored).then_some(own.fitness),
                verdict(&own.verdict),
            ),
            Err(why) => (None, why.to_string()),
        };
        let objective = objective.map_or_else(|| MISSING.to_owned(), significant);
        let values = row.iter().map(|value| significant(*value));
        Row::new(
            place.to_string(),
            [objective, ending].into_iter().chain(values),
        )
    };
    let heading = objective_heading(case);
    let fixed = ["row", heading.as_str(), "simulation"];
    let unit = |name: &String| {
        let unknown = case.unknowns.iter().find(|own| own.name == *name);
        unknown.map_or_else(|| name.clone(), |own| with_unit(name, &own.unit))
    };
    let fixed = fixed.into_iter().map(str::to_owned);
    let table = Table {
        title: "Individuals".to_owned(),
        head: fixed.chain(names.iter().map(unit)).collect(),
        rows: all.iter().take(MOST).map(row).collect(),
        notes: Vec::new(),
    };
    let note = format!(
        "The best {} of {} individuals; sweep.csv has all of them.",
        count(MOST as u64),
        count(all.len() as u64)
    );
    let table = table.with_notes((all.len() > MOST).then_some(note));
    let title = format!("Individuals of a table on {}", case.name);
    page(title, (case, origin), lead, table)
}

/// Formats an objective with its unit.
fn objective_words(case: &Case, objective: f64) -> String {
    let unit = square_after(case.objective_unit());
    format!("{}{unit}", significant(objective))
}

fn page(title: String, (case, origin): (&Case, &Origin), lead: String, table: Table) -> Report {
    let synthetic = origin.synthetic.then(|| Block::Text(SYNTHETIC.to_owned()));
    let blocks = [Block::Lead(lead)].into_iter().chain(synthetic);
    let outcome = Section {
        id: "outcome",
        title: "Outcome",
        blocks: blocks.chain([Block::Table(table)]).collect(),
    };
    let made = origin::section(vec![Block::Facts(origin::facts(origin, case))]);
    Report::new(title, &origin.run, vec![outcome, made])
}
