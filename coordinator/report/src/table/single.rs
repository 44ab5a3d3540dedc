//! Tables of one simulation, for models of any kind.
use crate::data::{SimulationView, SingleRun};
use crate::document::{Row, Table};
use crate::number::{MISSING, count, duration, fixed, percent, range, significant, squared, unit};
use crate::words::{channel_title, condition_name, verdict};
use protocol::case::Channel;
use protocol::job::Counters;

/// Creates a table row with a label, a unit and one value.
pub fn value_row(label: &str, unit: &str, value: String) -> Row {
    Row::new(label, [unit.to_owned(), value])
}

/// Creates a table row with the range of a curve scaled by `factor`: smallest value, largest value, half
/// range.
pub fn range_row(label: &str, values: &[f64], factor: f64, unit: &str) -> Row {
    let ends = range(values.iter().map(|value| factor * value));
    let cells = ends.map_or([MISSING; 3].map(str::to_owned), |(low, high)| {
        [low, high, 0.5 * (high - low)].map(|value| fixed(value, 2))
    });
    Row::new(label, std::iter::once(unit.to_owned()).chain(cells))
}

/// Builds one table row per channel with the range of its simulated curve.
pub fn ranges(of: &SimulationView<'_>) -> Vec<Row> {
    let channels = of.case.channels_of(of.condition);
    let row = |(_, channel): (usize, &Channel)| {
        let unit = unit(&channel.unit);
        range_row(&channel.title, of.channel(channel), 1.0, &unit)
    };
    channels.map(row).collect()
}

/// Builds the table of a simulation's curve ranges, titled with condition, parameter set and verdict.
pub fn simulation(run: &SingleRun, ranges: Vec<Row>) -> Table {
    let title = format!(
        "Condition {}, {} parameters: {}",
        condition_name(&run.case, run.condition),
        run.genes_name,
        verdict(&run.curves.verdict)
    );
    let head = ["", "unit", "smallest", "largest", "half range"];
    Table::new(title, head, ranges)
}

/// Builds a table of rows with one value each.
pub fn value_table(title: &str, rows: Vec<Row>) -> Table {
    Table::new(title, ["", "unit", "value"], rows)
}

/// Builds the table rows on agreement with the measured record: objective and errors by channel; empty if
/// nothing was scored.
pub fn agreement(run: &SingleRun) -> Vec<Row> {
    let scored = run.evaluation.as_ref();
    let Some(evaluation) = scored.filter(|scored| !scored.channels.is_empty()) else {
        return Vec::new();
    };
    let unit = squared(run.case.objective_unit());
    let mut rows = vec![
        Row::group("Against the record"),
        value_row("objective", &unit, significant(evaluation.fitness)),
    ];
    for score in &evaluation.channels {
        let channel = run.case.channels.get(score.channel);
        let title = channel_title(&run.case, score.channel);
        let unit = squared(channel.map(|channel| channel.unit.as_str()));
        let error = format!("{title}: mean squared error");
        rows.push(value_row(&error, &unit, significant(score.mse)));
        let error = format!("{title}: relative error");
        rows.push(value_row(&error, "", percent(score.relative_error)));
    }
    rows
}

/// Builds the table rows of the integrator's work counters and the wall time of a simulation.
pub fn work(counters: &Counters, wall_s: f64) -> Vec<Row> {
    let counted = counters.labelled().into_iter();
    let mut rows = vec![Row::group("Work of the integrator")];
    rows.extend(counted.map(|(_, what, number)| value_row(what, "", count(number))));
    rows.push(value_row("wall time", "", duration(wall_s)));
    rows
}

/// Builds the table of a simulation's parameters next to the recommended ones.
pub(crate) fn genes(run: &SingleRun) -> Table {
    let genes = run.case.unknowns.iter().zip(&run.genes);
    Table::new(
        format!("Parameters: {}", run.genes_name),
        ["", "unit", "value", "recommended"],
        genes
            .map(|(gene, &value)| {
                Row::of(
                    gene,
                    [
                        unit(&gene.unit),
                        significant(value),
                        significant(gene.start),
                    ],
                )
            })
            .collect(),
    )
}
