//! Command `bench scaling`: searches on more slots than there are, from what `horsehead sweep scaling` measured.
//!
//! *Slept*: sessions of another process that sleep for as long as simulations take; everything else is real. *Projected*:
//! the coordinator's own scheduler on a simulated clock. Both minimise a sum of squares with one minimum in the case's
//! space: their individuals are not those of the case.
mod project;
mod row;
mod sleeping;

use crate::{
    dispatch::sessions::open_with_connections,
    output::{Output, table},
};
use anyhow::{Context as _, ensure};
use case::{Overrides, load};
use clap::{Args, builder::PossibleValuesParser};
use dispatch::bench::{BenchPlan, Load, measure_on, processor_time};
use project::{Overheads, project};
use row::{SlotRow, empty_run};
use search::{
    space::Space,
    strategy::{CATALOGUE, SearchPlan, Strategy, build, preset},
};
use serde::Serialize;
use sleeping::sleep_through;
use std::{fs, path::PathBuf, time::Instant};
use study::scaling::ScalingResult;

/// Benchmark of the coordinator's cost per result: number of sessions, number of jobs, and bytes per result
/// (about the size of a score).
const COST: (usize, u64, u32) = (16, 4000, 300);
/// Minimum number of evaluations per slot in a search on sleeping sessions.
const EVALUATIONS_PER_SLOT: u64 = 8;

/// Run searches on sleeping sessions, and project them to more slots.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  horsehead sweep scaling cases/cyjs10-5-37hb --evaluations 80 --run scaling
  bench scaling cases/cyjs10-5-37hb --measured scaling --projected 4,8,16,32,80,1000,10000
  bench scaling cases/cyjs10-5-37hb --measured scaling --sleeping 64,512

Assumptions: simulations take what was measured in the row with the fewest slots, drawn from its quantiles; the
coordinator takes as long over each result as it does here over results of 300 bytes, one after the other; a message takes
up to the round trip of loopback; derivatives are divided where slots would be idle; one coordinator has at most 1,000
workers, of which one in ten is half as fast; all have joined and have the case, and none fails.")]
pub(crate) struct Arguments {
    /// Case folder.
    case: PathBuf,
    /// Run folder of `horsehead sweep scaling`.
    #[arg(long, value_name = "DIR")]
    measured: PathBuf,
    /// Presets to search with.
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_value = "paper,window,quick,least-squares,hybrid",
        value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name))
    )]
    presets: Vec<String>,
    /// Numbers of sleeping sessions.
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = clap::value_parser!(u64).range(1..=990))]
    sleeping: Vec<u64>,
    /// Mean sleep time of a job (s).
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    sleep: f64,
    /// Evaluations of a search on sleeping sessions; at least 8 for each.
    #[arg(long, value_name = "N", default_value_t = 160)]
    evaluations: u64,
    /// Numbers of slots to project to.
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = clap::value_parser!(u64).range(1..=20_000))]
    projected: Vec<u64>,
    /// Fixes every random choice.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    output: Output,
}

/// Result as printed with `--output json`.
#[derive(Debug, Serialize)]
struct Object {
    overheads: Overheads,
    rows: Vec<SlotRow>,
}

/// Runs and prints the searches.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let case = load(&arguments.case, &Overrides::default())?;
    let space = Space::new(&case.unknowns)?;
    let file = arguments.measured.join("result.json");
    let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let measured: ScalingResult =
        serde_json::from_str(&text).with_context(|| file.display().to_string())?;
    ensure!(
        !(arguments.sleeping.is_empty() && arguments.projected.is_empty()),
        "nothing is asked for: name numbers of slots with --sleeping or --projected"
    );
    let object = tokio::runtime::Runtime::new()?.block_on(rows(arguments, &space, &measured))?;
    let mut shown = table(&[
        "search",
        "slots",
        "evaluations",
        "wall time [s]",
        "useful",
        "barrier",
        "starved",
        "coordinator",
    ]);
    for row in &object.rows {
        shown.add_row([
            format!("{}, {}", row.preset, row.how),
            row.slots.to_string(),
            row.evaluations.to_string(),
            format!("{:.1}", row.wall_s),
            format!("{:.2}", row.shares.useful),
            format!("{:.2}", row.shares.barrier),
            format!("{:.2}", row.shares.starved),
            format!("{:.2}", row.coordinator_share),
        ]);
    }
    arguments.output.print(&shown, &object)
}

async fn rows(
    arguments: &Arguments,
    space: &Space,
    measured: &ScalingResult,
) -> anyhow::Result<Object> {
    let alone = measured.rows.iter().min_by_key(|row| row.slots);
    let alone = alone.context("the run measured nothing")?;
    let (coordinator_us, round_trip_ms) = cost().await?;
    let overheads = Overheads {
        simulation_s: alone.simulation_s,
        simulation_quantiles_s: alone.simulation_quantiles_s.clone(),
        coordinator_us,
        round_trip_ms,
        derivatives_over_plain: alone.derivatives_over_plain,
    };
    let mut rows = Vec::new();
    for name in &arguments.presets {
        let strategy = |slots: u64| -> anyhow::Result<Box<dyn Strategy>> {
            let preset = preset(name).context("the catalogue has lost a preset")?;
            let workers = usize::try_from(slots)?;
            let settings = (preset.settings)(&SearchPlan { space, workers });
            Ok(build(&settings, space, arguments.seed)?)
        };
        for slots in arguments.sleeping.iter().copied() {
            let limit = arguments.evaluations.max(EVALUATIONS_PER_SLOT * slots);
            let search = (name.as_str(), strategy(slots)?, limit);
            rows.push(sleep_through(search, (slots, arguments.sleep), space, &overheads).await?);
        }
        for slots in arguments.projected.iter().copied() {
            rows.push(project(name, strategy(slots)?, space, slots, &overheads));
        }
    }
    Ok(Object { overheads, rows })
}

/// Measures the coordinator's processor time per result \[us\] and the round trip of an empty job \[ms\].
async fn cost() -> anyhow::Result<(f64, f64)> {
    let (workers, jobs, result_bytes) = COST;
    let scratch = tempfile::tempdir()?;
    let begun = Instant::now();
    let opened = open_with_connections(empty_run(scratch.path())?, workers).await?;
    let (mut dispatch, connections, _folder) = opened;
    let plan = BenchPlan {
        workers,
        jobs,
        result_bytes,
    };
    let mut load = Load::new(workers, result_bytes);
    let result = measure_on(&mut dispatch, &mut load, plan, (begun, processor_time)).await?;
    dispatch.close().await?;
    drop(connections);
    Ok((result.coordinator_cpu_us_per_job, result.rtt_ms.median))
}
