//! Methods of integration side by side.
use super::{Label, Row, Table};
use crate::report::number::{NONE, count, duration, figure};
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
        rows.extend(own.iter().map(|point| row(point, cheapest == Some(*point))));
    }
    if let Some(fixed) = &all.fixed {
        rows.push(Row::Group("bdf, fixed step, extrapolated".to_owned()));
        rows.push(Row::Values(
            Label::Text(format!("{:e} s", fixed.step_s)),
            vec![
                figure(fixed.steps as f64 / fixed.share),
                NONE.to_owned(),
                figure(fixed.whole_iterations()),
                NONE.to_owned(),
                duration(fixed.whole_s()),
                NONE.to_owned(),
                NONE.to_owned(),
            ],
        ));
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

fn row(point: &WorkPoint, best: bool) -> Row {
    let counters = &point.counters;
    let mark = if best { " *" } else { "" };
    let error = match (point.error, point.verdict) {
        (Some(error), _) => format!("{:.3} %", 100.0 * error),
        (None, Verdict::Complete) => NONE.to_owned(),
        (None, failed) => verdict(&failed),
    };
    Row::Values(
        Label::Text(format!(
            "{}, {} s{mark}",
            point.tolerance, point.longest_step_s
        )),
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
    let mut notes = vec![
        format!(
            "error: root mean square difference to a converged run, over the range of the worst \
             gauge; two converged runs are {:.1e} apart.",
            all.resolution
        ),
        "*: the fastest run of a method with an error below 1 %.".to_owned(),
        "iterations: a stage of rodas4, one linear solution, counts as one.".to_owned(),
    ];
    if let Some(fixed) = &all.fixed {
        notes.push(format!(
            "fixed step: extrapolated from {} steps at the beginning of the run, {:.2} % of it, with \
             {:.2} iterations a step.",
            fixed.steps,
            100.0 * fixed.share,
            fixed.iterations as f64 / fixed.steps.max(1) as f64
        ));
    }
    notes
}
