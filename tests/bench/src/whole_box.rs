//! Command `bench box`: verdicts and cost of individuals spread over the whole search box.
//!
//! The points are a seeded Latin hypercube over the logarithms of the genes, so that the same case, seed and
//! number of points give the same individuals. Everything but the wall times is deterministic.
use crate::machine::{Machine, MachineChoice};
use crate::output::{Output, table};
use crate::verdicts::{Class, RunRecord, classes};
use clap::Args;
use comfy_table::Table;
use protocol::case::Case;
use protocol::pumping_unit::Discretisation;
use search::space::{Interval, Space};
use search::strategy::latin_hypercube;
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// Simulate individuals over the whole search box: verdicts, Newton iterations, times.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  bench box cases/cyjs10-5-37hb --points 1000 --out box
  bench box cases/cyjs10-5-37hb --points 200 --decades 1 --threads 1

--out writes box.csv, one row per individual. Every run ends complete or with a named failure, within its
budget of iterations. Verdicts and iterations are the same on any machine; times are those of a run that
has a core to itself: with as many threads as cores they disturb each other a little, with other programs
at work a lot.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    machine: MachineChoice,
    /// Number of individuals.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    points: u32,
    /// Largest distance from the recommended values in decades (for a parameter of an effect, in half-widths
    /// of its interval); by default the bounds of the case.
    #[arg(long, value_name = "X", value_parser = decades)]
    decades: Option<f64>,
    /// Seed of the Latin hypercube of individuals.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Number of simultaneous simulations [default: one per core].
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    #[command(flatten)]
    output: Output,
}

fn decades(typed: &str) -> Result<f64, String> {
    let value: f64 = typed.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value <= 100.0 {
        return Ok(value);
    }
    Err("must be above 0, at most 100".to_owned())
}

/// Result of `bench box` as printed with `--output json`.
#[derive(Debug, Serialize)]
struct Object<'a> {
    points: u32,
    seed: u64,
    classes: &'a [Class],
}

/// Simulates the individuals, counts their verdicts and writes the results.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let machine = arguments.machine.load()?;
    let individuals = individuals(&Space::new(&machine.case.unknowns)?, arguments);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.unwrap_or(cores).max(1);
    let output = &arguments.output;
    let done = |so_far: usize| output.print_progress(&format!("{so_far} of {}", individuals.len()));
    let ended = simulate(&machine, &individuals, threads, done)?;
    output.write("box.csv", || rows(&machine.case, &individuals, &ended))?;
    let classes = classes(&ended);
    let object = Object {
        points: arguments.points,
        seed: arguments.seed,
        classes: &classes,
    };
    output.print(&counted(&classes), &object)
}

fn individuals(space: &Space, arguments: &Arguments) -> Vec<Vec<f64>> {
    let reach = arguments.decades.unwrap_or(f64::INFINITY);
    let near = Interval {
        from: -reach,
        to: reach,
    };
    let axes = space.axes().iter();
    let intervals: Vec<Interval> = axes
        .map(|axis| near.intersection(axis.interval()))
        .collect();
    let points = latin_hypercube(&intervals, arguments.points as usize, arguments.seed);
    points.iter().map(|point| space.values(point)).collect()
}

/// Simulates all individuals on several threads, reports progress after every hundred, and returns the
/// results in the order of the individuals.
fn simulate(
    machine: &Machine,
    individuals: &[Vec<f64>],
    threads: usize,
    done: impl Fn(usize) -> anyhow::Result<()>,
) -> anyhow::Result<Vec<RunRecord>> {
    let next = AtomicUsize::new(0);
    // a thread ends when nothing is left, or when nobody listens any more because of an error
    let work = |to: &mpsc::Sender<_>| {
        let at = next.fetch_add(1, Ordering::Relaxed);
        let genes = individuals.get(at)?;
        let simulated = machine
            .simulate(genes, Discretisation::OF_THE_CASE)
            .map(|done| RunRecord {
                verdict: done.verdict,
                counters: done.counters,
                wall_s: done.wall_s,
            });
        to.send((at, simulated)).ok()
    };
    let mut ended = vec![None; individuals.len()];
    thread::scope(|scope| {
        let (to, ends) = mpsc::channel();
        for to in vec![to; threads] {
            scope.spawn(move || while work(&to).is_some() {});
        }
        for (so_far, (at, simulated)) in (1..).zip(ends) {
            ended[at] = Some(simulated?);
            if so_far % 100 == 0 {
                done(so_far)?;
            }
        }
        anyhow::Ok(())
    })?;
    Ok(ended.into_iter().flatten().collect())
}

/// Formats the individuals as CSV: parameter values in the case's units, verdict and cost.
fn rows(case: &Case, genes: &[Vec<f64>], ended: &[RunRecord]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let rest = [
        "verdict",
        "load_fraction",
        "time_fraction",
        "steps",
        "newton_iterations",
        "factorizations",
        "wall_s",
    ];
    let names = case.unknowns.iter().map(|unknown| unknown.name.clone());
    let head = std::iter::once("point".to_owned()).chain(names);
    writer.write_record(head.chain(rest.map(str::to_owned)))?;
    for (index, (genes, one)) in genes.iter().zip(ended).enumerate() {
        let (verdict, counters) = (one.verdict, &one.counters);
        let share = |share: Option<f64>| share.map(|x| x.to_string()).unwrap_or_default();
        let mut fields = vec![index.to_string()];
        fields.extend(genes.iter().map(f64::to_string));
        fields.extend([
            verdict.as_str().to_owned(),
            share(verdict.load_fraction()),
            share(verdict.time_fraction()),
            counters.steps.to_string(),
            counters.newton_iterations.to_string(),
            counters.factorizations.to_string(),
            one.wall_s.to_string(),
        ]);
        writer.write_record(fields)?;
    }
    Ok(writer.into_inner()?)
}

/// Builds the table with one row per verdict, the most frequent first, followed by all failures together.
fn counted(classes: &[Class]) -> Table {
    let mut table = table(&[
        "verdict",
        "runs",
        "iterations, median",
        "90 %",
        "most",
        "time [s], median",
        "90 %",
        "most",
    ]);
    for class in classes {
        let stage = class.stage.map(|stage| format!(", {stage}"));
        let mut cells = vec![
            format!("{}{}", class.verdict, stage.unwrap_or_default()),
            class.runs.to_string(),
        ];
        cells.extend(class.newton_iterations.map(|count| count.to_string()));
        cells.extend(class.wall_s.map(|time| format!("{time:.3}")));
        table.add_row(cells);
    }
    table
}
