//! Report section with the table of the individuals, which the script sorts and filters, and the page of one of
//! them.
use super::gene::selection;
use crate::chart;
use crate::data::{Calibration, ConditionResult, HistoryPoint};
use crate::document::{Block, Fact, Section, figures};
use crate::number::{MISSING, count, duration, quantity, significant};
use crate::words::{condition_name, objective_heading};
use maud::{Markup, html};
use protocol::case::Case;

/// Maximum number of individuals that the table lists, including the best ones.
const MOST: usize = 1000;
/// Number of best individuals that are always listed.
const ELITE: usize = 500;

/// Builds the table of the individuals; of many, the best ones and an even selection of the others.
pub(super) fn calibration(calibration: &Calibration) -> Section {
    let history = &calibration.history;
    let mut chosen = selection(history, ELITE, MOST);
    chosen.reverse();
    Section {
        id: "individuals",
        title: "Individuals",
        blocks: if history.is_empty() {
            Vec::new()
        } else {
            vec![Block::Markup(table(calibration, &chosen))]
        },
    }
}

fn table(calibration: &Calibration, chosen: &[usize]) -> Markup {
    let unknowns = &calibration.case.unknowns;
    let objective = objective_heading(&calibration.case);
    let first = unknowns
        .first()
        .map_or("time", |unknown| unknown.name.as_str());
    let placeholder = format!("words, or objective<10 {first}>1");
    html! {
        figure.table.individuals {
            p.filter {
                label {
                    "Filter "
                    input type="search" id="individuals-filter" size="34"
                        placeholder=(placeholder);
                }
                " " span.count {}
            }
            div.scroll.tall {
                table data-sortable="" {
                    thead {
                        tr {
                            th scope="col" data-name="individual" { "individual" }
                            th scope="col" data-name="generation" { "generation" }
                            th scope="col" data-name="purpose" { "purpose" }
                            th scope="col" data-name="objective" { (objective) }
                            th scope="col" data-name="time" { "time" }
                            @for unknown in unknowns {
                                th scope="col" data-name=(unknown.name) title=(unknown.title) { (unknown.name) }
                            }
                            th scope="col" data-name="ended" { "how it ended" }
                        }
                    }
                    tbody {
                        @for &index in chosen { (row(&calibration.history[index])) }
                    }
                }
            }
            @if calibration.history.len() > chosen.len() {
                p.note {
                    "The best " (ELITE) " and an even selection of the others, " (chosen.len()) " of "
                    (count(calibration.history.len() as u64)) " in all. `horsehead export` writes all."
                }
            }
            div id="individual" {}
        }
    }
}

fn row(point: &HistoryPoint) -> Markup {
    let complete = point.complete && point.fitness.is_finite();
    let time = point.cost.map(|cost| cost.wall_s);
    html! {
        tr data-individual=(point.id) {
            th scope="row" { (point.id) }
            td { (point.generation) }
            td { (point.purpose) }
            td data-value=[complete.then_some(point.fitness)] {
                (if complete { significant(point.fitness) } else { MISSING.to_owned() })
            }
            td data-value=[time] { (time.map_or_else(|| MISSING.to_owned(), duration)) }
            @for gene in &point.genes {
                td data-value=[gene.is_finite().then_some(gene)] { (significant(*gene)) }
            }
            td { (point.failure.as_deref().unwrap_or("complete")) }
        }
    }
}

/// Builds the section of one individual, number `number`, beside the recommended one.
pub(crate) fn one(
    case: &Case,
    (number, genes): (u64, &[f64]),
    conditions: &[ConditionResult],
) -> Section {
    let values = case.unknowns.iter().zip(genes);
    let facts = values
        .map(|(unknown, value)| Fact::new(unknown.name.as_str(), quantity(*value, &unknown.unit)));
    let mut blocks = vec![
        Block::Lead(format!(
            "Individual {number}, in place of the optimised one."
        )),
        Block::Folded(
            "Values of its unknowns",
            vec![Block::Facts(facts.collect())],
        ),
    ];
    for result in conditions {
        let overlays = chart::overlays(case, result);
        if !overlays.is_empty() {
            let name = condition_name(case, result.condition);
            blocks.push(Block::Heading(format!("Condition {name}"), ""));
            blocks.extend(figures(overlays));
        }
    }
    Section {
        id: "one-individual",
        title: "One individual",
        blocks,
    }
}
