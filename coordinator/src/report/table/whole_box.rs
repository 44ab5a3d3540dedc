//! How individuals from all over the box of genes ended.
use super::{Row, Table};
use crate::report::number::{count, duration};
use crate::report::words::failure;
use crate::study::BoxClass;
use protocol::job::{Reached, Verdict};

/// One row per verdict, the commonest first, then all that failed.
pub fn whole_box(classes: &[BoxClass], points: usize) -> Table {
    let rows = classes.iter().map(|class| {
        let iterations = class.iterations.map(count);
        let times = class.wall_s.map(duration);
        let cells = std::iter::once(class.runs.to_string())
            .chain(iterations)
            .chain(times);
        Row::new(ended(class.verdict), cells)
    });
    let head = [
        "",
        "runs",
        "iterations",
        "90 %",
        "most",
        "time",
        "90 %",
        "most",
    ];
    Table {
        title: format!("How {points} individuals of the box ended"),
        head: head.map(str::to_owned).to_vec(),
        rows: rows.collect(),
        notes: vec![
            "Newton iterations and wall time: the median, what nine in ten do not exceed, the most."
                .to_owned(),
        ],
    }
}

fn ended(verdict: Option<Verdict>) -> String {
    match verdict {
        None => "all that failed".to_owned(),
        Some(Verdict::Complete) => "complete".to_owned(),
        Some(Verdict::Failed { kind, reached }) => {
            let stage = match reached {
                Reached::LoadFraction(_) => "under load",
                Reached::TimeFraction(_) => "in motion",
            };
            format!("{stage}: {}", failure(kind))
        }
    }
}
