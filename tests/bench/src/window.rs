//! Command `bench window`: what breeding from older results costs, and what share of a cluster's capacity it uses.
use crate::output::{Output, table};
use clap::Args;
use comfy_table::Table;
use dispatch::simulated::{Cluster, ClusterSetting, Generations, SimulatedSearch};
use search::{
    strategy::{
        Settings, build,
        memetic::{MemeticSettings, window::WindowSettings},
    },
    test_function::{self, CLIFF, TestFunction},
};
use serde::Serialize;
use std::time::Duration;

/// Number of seeds of which the median is taken.
const SEEDS: u64 = 25;
/// Evaluations of each search.
const EVALUATIONS: usize = 4880;
/// Lengths of the window.
const WINDOWS: [usize; 5] = [1, 16, 48, 120, 240];
/// Evaluations of a search on a simulated cluster: with generations, and with a window.
const ON_CLUSTER: [u32; 2] = [4000, 16_000];
/// Longest simulated time of a search.
const LIMIT: Duration = Duration::from_hours(20);

/// Compare the window of the memetic search with generations: best fitness, and share of capacity used.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  bench window

Takes a minute in a release build. Fitness: medians of 25 seeds after 4,880 evaluations with the paper's settings. Capacity:
simulated clusters whose computing times vary by 30 % and of whose workers one in ten is half as fast.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    output: Output,
}

/// Result as printed with `--output json`.
#[derive(Debug, Serialize)]
struct Object {
    /// Median fitness by function: with generations, then for each length of the window.
    fitness: Vec<(String, Vec<f64>)>,
    /// Share of capacity used by number of workers: with generations, then with a window of 2 and of 3 individuals a
    /// worker.
    capacity: Vec<(u64, [f64; 3])>,
}

/// Runs the searches and prints both tables.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let memetic = MemeticSettings::paper;
    let window = |window| {
        Settings::of(&WindowSettings {
            window,
            memetic: memetic(),
        })
    };
    let mut fitness = Vec::new();
    for function in test_function::ALL {
        let mut row = vec![median(&Settings::of(&memetic()), function)?];
        for length in WINDOWS {
            row.push(median(&window(length), function)?);
        }
        fitness.push((function.name.to_owned(), row));
    }
    let mut capacity = Vec::new();
    for workers in [8, 16, 40, 80] {
        let shares = [
            generational(workers),
            windowed(workers, 2)?,
            windowed(workers, 3)?,
        ];
        capacity.push((workers, shares));
    }
    let object = Object { fitness, capacity };
    let head = [
        "function",
        "generations",
        "L = 1",
        "L = 16",
        "L = 48",
        "L = 120",
        "L = 240",
    ];
    let mut shown = table(&head);
    for (name, row) in &object.fitness {
        shown.add_row(
            std::iter::once(name.clone()).chain(row.iter().map(|own| format!("{own:.1e}"))),
        );
    }
    let mut shares: Table = table(&["workers", "generations", "2 a worker", "3 a worker"]);
    for (workers, row) in &object.capacity {
        shares.add_row(
            [workers.to_string()]
                .into_iter()
                .chain(row.map(|own| format!("{own:.2}"))),
        );
    }
    arguments
        .output
        .print(&format!("{shown}\n\n{shares}"), &object)
}

/// Returns the median over the seeds of the best fitness that a search finds.
fn median(settings: &Settings, function: &TestFunction) -> anyhow::Result<f64> {
    let space = function.space();
    let mut all = Vec::new();
    for seed in 1..=SEEDS {
        let mut search = build(settings, &space, seed)?;
        let mut evaluated = 0;
        while evaluated < EVALUATIONS && search.finished().is_none() {
            for proposal in search.ask() {
                if evaluated < EVALUATIONS {
                    search.tell(proposal.id, function.tell(&space, &proposal.genes));
                    evaluated += 1;
                }
            }
        }
        let entries = search.archive().entries().iter();
        let complete = entries.filter(|entry| entry.result.complete);
        all.push(
            complete
                .map(|entry| entry.result.fitness)
                .fold(f64::INFINITY, f64::min),
        );
    }
    all.sort_by(f64::total_cmp);
    Ok(all[all.len() / 2])
}

/// Builds a cluster of mixed speed.
fn mixed(workers: u64) -> Cluster {
    Cluster::new(ClusterSetting {
        slow_one_in: 10,
        ..ClusterSetting::even(workers)
    })
}

fn generational(workers: u64) -> f64 {
    let mut cluster = mixed(workers);
    let generations = u64::from(ON_CLUSTER[0] / 80);
    cluster.run(&mut Generations::new(80, generations), LIMIT);
    cluster.capacity_used()
}

fn windowed(workers: u64, per_worker: usize) -> anyhow::Result<f64> {
    let settings = Settings::of(&WindowSettings {
        window: per_worker * usize::try_from(workers)?,
        memetic: MemeticSettings {
            population: 30,
            generations: ON_CLUSTER[1] / 40,
            crossover_trials: 5,
            mutation_trials: 5,
            ..MemeticSettings::paper()
        },
    });
    let space = CLIFF.space();
    let tell = |genes: &[f64]| CLIFF.tell(&space, genes);
    let mut source = SimulatedSearch::new(build(&settings, &space, 11)?, &tell);
    let mut cluster = mixed(workers);
    cluster.run(&mut source, LIMIT);
    Ok(cluster.capacity_used())
}
