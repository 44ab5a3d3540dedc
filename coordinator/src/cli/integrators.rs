//! `horsehead bench integrators`: accuracy against work, by method of integration.
use super::{
    CaseChoice, EXIT_CODES, IndividualChoice, Output, OutputChoice, bus, output, problem::Usage,
    simulate::check_out,
};
use crate::{
    report::{self, table, words},
    study::{self, WorkPlan, WorkPoint, WorkPrecision},
};
use clap::Args;
use protocol::{
    case::{Case, Integrator},
    job::Verdict,
};
use serde::Serialize;
use std::path::PathBuf;

/// Compare methods of integration: error of the gauge curves against Newton iterations and time.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead bench integrators cases/cyjs10-5-37hb --out integrators
  horsehead bench integrators cases/cyjs10-5-37hb --methods esdirk4,rodas4 --levels 4
  horsehead bench integrators cases/cyjs10-5-37hb --methods bdf --levels 1 --fixed

Runs one after the other on one worker, so that wall times do not disturb each other.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    #[command(flatten)]
    individual: IndividualChoice,
    /// Methods, as written in case files; all by default.
    #[arg(
        long,
        value_name = "NAME",
        value_delimiter = ',',
        env = "HORSEHEAD_METHODS"
    )]
    methods: Vec<String>,
    /// How many levels of accuracy, from the coarse end; 0 for all.
    #[arg(long, value_name = "N", default_value_t = 0, env = "HORSEHEAD_LEVELS")]
    levels: usize,
    /// Run the reference paper's fixed step of 1e-5 s too, over the whole run: some 1.5 million steps,
    /// about a minute.
    #[arg(long, env = "HORSEHEAD_FIXED")]
    fixed: bool,
    /// Folder for `integrators.svg` and `integrators.csv`; none are written without.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Runs, compares, writes.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let loaded = arguments.choice.load()?;
    let case = &loaded.case;
    let plan = WorkPlan {
        condition: arguments.individual.condition(case)?,
        genes: arguments.individual.genes(case)?,
        methods: methods(&arguments.methods)?,
        levels: arguments.levels,
        fixed: arguments.fixed,
    };
    if let Some(folder) = &arguments.out {
        check_out(folder)?;
    }
    let tell = arguments.output.output == Output::Table;
    let all = compare(case, &plan, tell)?;
    if let Some(folder) = &arguments.out {
        for path in report::write_work_precision(folder, &all)? {
            output::tell(&format!("wrote {}", path.display()));
        }
    }
    let tables = || table::text(&table::work_precision(&all), output::styled());
    output::print(arguments.output.output, tables, &object(&all))
}

fn methods(typed: &[String]) -> Result<Vec<Integrator>, Usage> {
    if typed.is_empty() {
        return Ok(Integrator::ALL.to_vec());
    }
    let find = |name: &String| {
        let known = Integrator::ALL.into_iter();
        known
            .clone()
            .find(|integrator| integrator.as_str() == name)
            .ok_or_else(|| {
                let known: Vec<&str> = known.map(Integrator::as_str).collect();
                Usage {
                    message: format!("there is no method `{name}`"),
                    help: format!("there are: {}", known.join(", ")),
                }
            })
    };
    typed.iter().map(find).collect()
}

/// Compares on one local worker, without a run folder that outlives the command.
fn compare(case: &Case, plan: &WorkPlan, tell: bool) -> anyhow::Result<WorkPrecision> {
    let done = |point: &WorkPoint| {
        if tell {
            output::tell(&line(point));
        }
    };
    bus::in_scratch(case, ("bench integrators", 1), async |bus, stop| {
        study::work_precision(bus, plan, stop, done).await
    })
}

fn line(point: &WorkPoint) -> String {
    let ended = match point.error {
        Some(error) => format!("error {:.3} %", 100.0 * error),
        None => words::verdict(&point.verdict),
    };
    format!(
        "{:<18} tolerance {:<6} step {:<6} s: {:.3} s, {ended}",
        words::integrator_name(point.integrator),
        point.tolerance,
        point.longest_step_s,
        point.wall_s
    )
}

/// What `--output json` prints.
#[derive(Debug, Serialize)]
struct Object {
    /// How far two converged runs are apart, as an error (1).
    resolution: f64,
    points: Vec<PointObject>,
    /// The reference paper's fixed step over the whole run; null unless asked for.
    fixed_step: Option<PointObject>,
}

#[derive(Debug, Serialize)]
struct PointObject {
    integrator: Integrator,
    tolerance: f64,
    longest_step_s: f64,
    complete: bool,
    steps: u64,
    newton_iterations: u64,
    jacobians: u64,
    factorizations: u64,
    wall_s: f64,
    /// Root mean square difference over the range of the worst gauge (1).
    error: Option<f64>,
    energy_error: f64,
}

fn object(all: &WorkPrecision) -> Object {
    let point = |point: &WorkPoint| PointObject {
        integrator: point.integrator,
        tolerance: point.tolerance,
        longest_step_s: point.longest_step_s,
        complete: point.verdict == Verdict::Complete,
        steps: point.counters.steps,
        newton_iterations: point.counters.newton_iterations,
        jacobians: point.counters.jacobians,
        factorizations: point.counters.factorizations,
        wall_s: point.wall_s,
        error: point.error,
        energy_error: point.energy_error,
    };
    Object {
        resolution: all.resolution,
        points: all.points.iter().map(point).collect(),
        fixed_step: all.fixed.as_ref().map(point),
    }
}
