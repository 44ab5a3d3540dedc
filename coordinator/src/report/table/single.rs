//! One simulation in numbers: what every model has of it.
use crate::report::data::SingleRun;
use crate::report::document::{Row, Table};
use crate::report::number::{count, duration, figure, percent, squared, unit};
use crate::report::words::channel_title;
use protocol::job::Counters;

/// A row with one value.
pub(crate) fn one(label: &str, unit: &str, value: String) -> Row {
    Row::new(label, [unit.to_owned(), value])
}

/// Agreement with the record, as far as it was scored.
pub(crate) fn agreement(run: &SingleRun) -> Vec<Row> {
    let scored = run.evaluation.as_ref();
    let Some(evaluation) = scored.filter(|scored| !scored.channels.is_empty()) else {
        return Vec::new();
    };
    let unit = squared(run.case.objective_unit());
    let mut rows = vec![
        Row::group("Against the record"),
        one("objective", &unit, figure(evaluation.fitness)),
    ];
    for score in &evaluation.channels {
        let channel = run.case.channels.get(score.channel);
        let title = channel_title(&run.case, score.channel);
        let unit = squared(channel.map(|channel| channel.unit.as_str()));
        let error = format!("{title}: mean squared error");
        rows.push(one(&error, &unit, figure(score.mse)));
        let error = format!("{title}: relative error");
        rows.push(one(&error, "", percent(score.relative_error)));
    }
    rows
}

/// What the simulation took.
pub(crate) fn work(counters: &Counters, wall_s: f64) -> Vec<Row> {
    let counted = counters.named().into_iter();
    let mut rows = vec![Row::group("Work of the integrator")];
    rows.extend(counted.map(|(_, what, number)| one(what, "", count(number))));
    rows.push(one("wall time", "", duration(wall_s)));
    rows
}

/// The genes of one simulation beside the recommended ones.
pub(in crate::report) fn genes(run: &SingleRun) -> Table {
    let genes = run.case.unknowns.iter().zip(&run.genes);
    Table::new(
        format!("Parameters: {}", run.genes_name),
        ["", "unit", "value", "recommended"],
        genes
            .map(|(gene, &value)| {
                Row::of(gene, [unit(&gene.unit), figure(value), figure(gene.start)])
            })
            .collect(),
    )
}
