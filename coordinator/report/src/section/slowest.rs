//! Report section on the simulations with the largest processor time, and how they ended.
use crate::data::{Calibration, HistoryPoint};
use crate::document::{Block, Row, Section, Table};
use crate::number::{count, duration, fixed, significant};
use crate::words::objective_heading;
use journal::account::JobCost;

/// Number of slowest simulations listed in the section.
const LISTED: usize = 10;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let history = calibration.history.iter();
    let mut known: Vec<(&HistoryPoint, JobCost)> = history
        .filter_map(|point| Some((point, point.cost?)))
        .filter(|(_, cost)| cost.processor_s > 0.0)
        .collect();
    known.sort_by(|(_, a), (_, b)| b.processor_s.total_cmp(&a.processor_s));
    let mut times: Vec<f64> = known.iter().map(|(_, cost)| cost.processor_s).collect();
    times.reverse();
    let rows = known.iter().take(LISTED);
    let table = Table::new(
        "The slowest simulations",
        [
            "individual",
            "generation",
            "processor time",
            "wall time",
            "Newton iterations",
            &objective_heading(&calibration.case),
            "how it ended",
        ],
        rows.map(|(point, cost)| row(point, *cost)).collect(),
    );
    let table = table
        .non_empty()
        .map(|table| table.with_notes(note(&times)));
    Section {
        id: "slowest",
        title: "Where the time went",
        blocks: table.map(Block::Table).into_iter().collect(),
    }
}

fn row(point: &HistoryPoint, cost: JobCost) -> Row {
    let ended = point.failure.as_deref().unwrap_or("complete");
    Row::new(
        count(point.id),
        [
            point.generation.to_string(),
            duration(cost.processor_s),
            duration(cost.wall_s),
            count(cost.newton_iterations),
            significant(if point.complete {
                point.fitness
            } else {
                f64::NAN
            }),
            ended.replace('_', " "),
        ],
    )
}

/// Compares the processor time of the slowest simulation with the median; `times` are in ascending order.
fn note(times: &[f64]) -> Option<String> {
    let median = *times.get(times.len() / 2)?;
    let (all, longest) = (times.iter().sum::<f64>(), *times.last()?);
    Some(format!(
        "All {} simulations of the search took {} of processor time, half of them no more than {} each; \
         the slowest took {} times that. Wall time far above processor time: the slot's process had to \
         wait for a processor.",
        count(times.len() as u64),
        duration(all),
        duration(median),
        fixed(longest / median, 1)
    ))
}
