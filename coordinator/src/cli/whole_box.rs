//! `horsehead bench box`: how individuals end all over the box that a search may propose from.
use super::{
    CaseChoice, EXIT_CODES, Output, OutputChoice, bus, condition, output, progress,
    simulate::check_out,
};
use crate::{
    report::{self, table},
    study::{self, BoxClass, BoxPlan, BoxPoint},
};
use clap::Args;
use protocol::{
    case::Case,
    job::{Reached, Verdict},
};
use search::space::Space;
use serde::Serialize;
use std::path::PathBuf;

/// Simulate individuals from all over the box of genes: verdicts, Newton iterations, times.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead bench box cases/cyjs10-5-37hb --points 1000 --out box
  horsehead bench box cases/cyjs10-5-37hb --points 200 --decades 1 --workers 1

The points are a Latin hypercube over the logarithms of the genes, within the bounds of the case. Every
run ends complete or with a named failure, within its budget of iterations. Verdicts and iterations are
the same on any machine; times are those of a worker that has a core to itself: with as many workers as
cores they disturb each other a little, with other programs at work a lot.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// Working condition; that of the case's objective by default.
    #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
    condition: Option<String>,
    /// How many individuals.
    #[arg(long, value_name = "N", default_value_t = 1000, env = "HORSEHEAD_POINTS", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    points: u32,
    /// No farther from the recommended values than so many decades; to the bounds by default.
    #[arg(long, value_name = "X", env = "HORSEHEAD_DECADES", value_parser = decades)]
    decades: Option<f64>,
    /// Seed of the points.
    #[arg(long, value_name = "N", default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Worker processes to start on this machine [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = super::worker_count())]
    workers: Option<usize>,
    /// Folder for `box.csv`, one row per individual; none is written without.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

fn decades(typed: &str) -> Result<f64, String> {
    let value: f64 = typed.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value <= 100.0 {
        return Ok(value);
    }
    Err("must be above 0, at most 100".to_owned())
}

/// Runs, counts, writes.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let loaded = arguments.choice.load()?;
    let case = &loaded.case;
    let plan = BoxPlan {
        condition: condition(case, arguments.condition.as_deref())?,
        points: arguments.points as usize,
        decades: arguments.decades,
        seed: arguments.seed,
    };
    if let Some(folder) = &arguments.out {
        check_out(folder)?;
    }
    let workers = arguments.workers.unwrap_or_else(super::cores).max(1);
    let points = simulate(
        case,
        &plan,
        workers,
        arguments.output.output == Output::Table,
    )?;
    if let Some(folder) = &arguments.out {
        let path = report::write_box(folder, case, &points)?;
        output::tell(&format!("wrote {}", path.display()));
    }
    let classes = study::box_classes(&points);
    let tables = || table::text(&table::whole_box(&classes, points.len()), output::styled());
    let object = Object {
        points: points.len(),
        seed: plan.seed,
        classes: classes.iter().map(ClassObject::from).collect(),
    };
    output::print(arguments.output.output, tables, &object)
}

/// Simulates on local workers, without a run folder that outlives the command.
fn simulate(
    case: &Case,
    plan: &BoxPlan,
    workers: usize,
    tell: bool,
) -> anyhow::Result<Vec<BoxPoint>> {
    let space = Space::new(&case.genes)?;
    let counter = progress::Counter::new(plan.points, tell);
    let done = |ended: usize, _: &BoxPoint| counter.show(ended);
    let points = bus::in_scratch(case, ("bench box", workers), async |bus, stop| {
        study::whole_box(bus, (&space, plan), stop, done).await
    });
    counter.clear();
    points
}

/// What `--output json` prints.
#[derive(Debug, Serialize)]
struct Object {
    points: usize,
    seed: u64,
    /// The commonest first; the last one is all that failed, if any did.
    classes: Vec<ClassObject>,
}

#[derive(Debug, Serialize)]
struct ClassObject {
    /// `complete`, a kind of failure, or `failed` for all of them.
    verdict: &'static str,
    /// `under_load` or `in_motion`; null for complete runs and for all failures together.
    stage: Option<&'static str>,
    runs: usize,
    /// Median, nine in ten, most.
    newton_iterations: [u64; 3],
    wall_s: [f64; 3],
}

impl From<&BoxClass> for ClassObject {
    fn from(class: &BoxClass) -> Self {
        let (verdict, stage) = match class.verdict {
            None => ("failed", None),
            Some(Verdict::Complete) => ("complete", None),
            Some(Verdict::Failed { kind, reached }) => {
                let stage = match reached {
                    Reached::LoadFraction(_) => "under_load",
                    Reached::TimeFraction(_) => "in_motion",
                };
                (kind.as_str(), Some(stage))
            }
        };
        Self {
            verdict,
            stage,
            runs: class.runs,
            newton_iterations: class.iterations,
            wall_s: class.wall_s,
        }
    }
}
