//! Command `bench integrators`: accuracy against work for each time integration method, as table, CSV and
//! figure.
use crate::figure::error_against_work;
use crate::machine::MachineChoice;
use crate::output::{Output, table};
use crate::work::{Comparison, Integrator, Plan, Point, compare};
use case::read_genes;
use clap::Args;
use comfy_table::Table;
use std::path::PathBuf;

/// Compare time integration methods: error of the gauge curves against Newton iterations and wall time.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  bench integrators cases/cyjs10-5-37hb --out integrators
  bench integrators cases/cyjs10-5-37hb --methods esdirk4,rodas4 --levels 4
  bench integrators cases/cyjs10-5-37hb --methods bdf --levels 1 --fixed

--out writes integrators.svg and integrators.csv. Runs are made one at a time, so that wall times do not
disturb each other.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    machine: MachineChoice,
    /// Gene file with the parameters, such as a run's `calibrated.toml`; the recommended values by default.
    #[arg(long, value_name = "FILE")]
    genes: Option<PathBuf>,
    /// Time integration methods to compare, all by default.
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = method)]
    methods: Vec<Integrator>,
    /// Number of accuracy levels, from the coarsest; 0 for all.
    #[arg(long, value_name = "N", default_value_t = 0)]
    levels: usize,
    /// Also run the reference paper's fixed step of 1e-5 s over the whole run: some 1.5 million steps, about
    /// a minute.
    #[arg(long)]
    fixed: bool,
    #[command(flatten)]
    output: Output,
}

fn method(typed: &str) -> Result<Integrator, String> {
    let found = Integrator::ALL.into_iter().find(|m| m.as_str() == typed);
    found.ok_or_else(|| {
        let known = Integrator::ALL.map(Integrator::as_str);
        format!("unknown method; the methods are: {}", known.join(", "))
    })
}

/// Runs all integration methods and writes their comparison as table, CSV and figure.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let machine = arguments.machine.load()?;
    let case = &machine.case;
    let plan = Plan {
        genes: match &arguments.genes {
            None => case.start(),
            Some(file) => read_genes(file, case)?,
        },
        methods: match arguments.methods.as_slice() {
            [] => Integrator::ALL.to_vec(),
            some => some.to_vec(),
        },
        levels: arguments.levels,
        fixed: arguments.fixed,
    };
    let output = &arguments.output;
    let done = |point: &Point| {
        let [name, limits] = [point.integrator.title(), &limits(point)];
        let time = point.wall_s;
        output.print_progress(&format!("{name:<18} {limits}: {time:.3} s, {}", end(point)))
    };
    let all = compare(&machine, &plan, done)?;
    let apart = all.resolution;
    output.print_progress(&format!(
        "the two reference runs differ by {apart:.1e} of the range"
    ))?;
    output.write("integrators.svg", || Ok(error_against_work(&all).into()))?;
    output.write("integrators.csv", || rows(&all.points))?;
    output.print(&side_by_side(&all), &all)
}

fn rows(points: &[Point]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for point in points {
        writer.serialize(point)?;
    }
    Ok(writer.into_inner()?)
}

fn limits(point: &Point) -> String {
    format!("{}, {:e} s", point.tolerance, point.longest_step_s)
}

/// Formats the error of a run in per cent, or the verdict of a failed run.
fn end(point: &Point) -> String {
    match point.error {
        Some(error) => format!("{:.3} %", 100.0 * error),
        None => format!("{:?}", point.verdict),
    }
}

/// Builds the table of every run of every method; an asterisk marks each method's fastest run with an error
/// below one per cent of the range.
fn side_by_side(all: &Comparison) -> Table {
    let mut table = table(&[
        "method",
        "tolerance, longest step",
        "steps",
        "rejected",
        "iterations",
        "factorisations",
        "wall time [s]",
        "error / range",
        "energy",
    ]);
    for point in all.points.iter().chain(&all.fixed_step) {
        let own = all.points.iter();
        let own = own.filter(|p| p.integrator == point.integrator);
        let good = own.filter(|p| p.error.is_some_and(|error| error < 0.01));
        let fastest = good.min_by(|a, b| a.wall_s.total_cmp(&b.wall_s));
        let mark = if fastest == Some(point) { " *" } else { "" };
        table.add_row([
            point.integrator.title().to_owned() + mark,
            limits(point),
            point.steps.to_string(),
            point.rejected_steps.to_string(),
            point.newton_iterations.to_string(),
            point.factorizations.to_string(),
            format!("{:.3}", point.wall_s),
            end(point),
            format!("{:.1e}", point.energy_error),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use std::fs;
    use std::path::Path;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    /// Checks that all runs are complete, that the more accurate method has the smaller error, that figure
    /// and table are written, and that the fixed step, which takes a minute, runs only on request.
    #[test]
    fn error_and_work_are_measured_drawn_and_written() {
        let scratch = tempfile::tempdir().unwrap();
        let case = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/cyjs10-5-37hb");
        let out = scratch.path().to_str().unwrap();
        let typed = [
            "bench",
            case,
            "--methods",
            "tr_bdf2,rodas4",
            "--levels",
            "2",
        ];
        let Line { arguments } = Line::parse_from(typed.iter().chain(&["--out", out]));
        assert!(!arguments.fixed);
        run(&arguments).unwrap();
        let read = |name: &str| fs::read_to_string(Path::new(out).join(name)).unwrap();
        let mut rows = csv::Reader::from_path(scratch.path().join("integrators.csv")).unwrap();
        let head = rows.headers().unwrap().clone();
        let column = |name: &str| head.iter().position(|one| one == name).unwrap();
        let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 4);
        assert!(rows.iter().all(|row| &row[column("complete")] == "true"));
        let error =
            |row: &csv::StringRecord| -> f64 { row[column("error_over_range")].parse().unwrap() };
        let [coarse, _, rodas, finer] = [0, 1, 2, 3].map(|k| error(&rows[k]));
        assert!(rodas < coarse && finer < rodas && finer < 0.01, "{rows:?}");
        let svg = read("integrators.svg");
        assert!(svg.contains("RODAS4") && svg.contains("wall time"));
    }
}
