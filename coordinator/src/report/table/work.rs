//! Methods of integration side by side.
use super::{Label, Row, Table};
use crate::report::number::{NONE, count, duration};
use crate::report::words::{integrator_name, verdict};
use crate::study::{WorkPoint, WorkPrecision};
use protocol::{case::Integrator, job::Verdict};

/// Every run of every method; the cheapest one of a method with an error below one per cent of the
/// range is marked.
pub fn work_precision(all: &WorkPrecision) -> Table {
    let mut rows = Vec::new();
    for integrator in Integrator::ALL {
        let own: Vec<&WorkPoint> = all
            .points
            .iter()
            .filter(|point| point.integrator == integrator)
            .collect();
        if own.is_empty() {
            continue;
        }
        rows.push(Row::Group(integrator_name(integrator).to_owned()));
        let good = own.iter().filter(|p| p.error.is_some_and(|e| e < 0.01));
        let cheapest = good.min_by(|a, b| a.wall_s.total_cmp(&b.wall_s)).copied();
        rows.extend(own.iter().map(|point| {
            let mark = if cheapest == Some(*point) { " *" } else { "" };
            let limits = format!("{}, {} s{mark}", point.tolerance, point.longest_step_s);
            row(limits, point)
        }));
    }
    if let Some(fixed) = &all.fixed {
        rows.push(Row::Group("bdf, fixed step".to_owned()));
        rows.push(row(format!("{:e} s", fixed.longest_step_s), fixed));
    }
    let head = [
        "tolerance, longest step",
        "steps",
        "rejected",
        "iterations",
        "factorisations",
        "wall time",
        "error / range",
        "energy",
    ];
    Table {
        title: "Methods of integration".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
        notes: notes(all),
    }
}

fn row(limits: String, point: &WorkPoint) -> Row {
    let counters = &point.counters;
    let error = match (point.error, point.verdict) {
        (Some(error), _) => format!("{:.3} %", 100.0 * error),
        (None, Verdict::Complete) => NONE.to_owned(),
        (None, failed) => verdict(&failed),
    };
    Row::Values(
        Label::Text(limits),
        vec![
            count(counters.steps),
            count(counters.rejected_steps),
            count(counters.newton_iterations),
            count(counters.factorizations),
            duration(point.wall_s),
            error,
            format!("{:.1e}", point.energy_error),
        ],
    )
}

fn notes(all: &WorkPrecision) -> Vec<String> {
    vec![
        format!(
            "error: root mean square difference to a converged run, over the range of the worst \
             gauge; two converged runs are {:.1e} apart.",
            all.resolution
        ),
        "*: the fastest run of a method with an error below 1 %.".to_owned(),
        "iterations: a stage of rodas4, one linear solution, counts as one.".to_owned(),
    ]
}
