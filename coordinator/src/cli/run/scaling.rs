//! Scaling measurement over numbers of worker slots: rows of the scaling table are measured one after
//! another, and each is stored in the run folder as soon as it is complete.
use super::{
    bus::{self, Bus, Options},
    folder::RunFolder,
    manifest::RunIdentity,
    opened::Run,
};
use crate::cli::{
    argument::{listening::RemoteAccess, settings},
    output::{problem::Problem, terminal},
};
use anyhow::Context as _;
use dispatch::account;
use dispatch::journal;
use dispatch::runtime::{self, BenchPlan, BenchWorkers, processor_time, sleep_through};
use dispatch::simulated::SimulatedSearch as JobSource;
use protocol::{case::Case, event::Spent};
use search::{
    space::Space,
    strategy::{SearchPlan, Settings, Strategy, build, preset},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs,
    time::{Duration, Instant},
};
use study::scaling::{
    Overheads, ScalingResult, ScalingRow, Shares, SlotMode, SyntheticObjective, project,
};
use study::{Evaluator as _, ProgressView, Search, Stop, Sweep, Watch, score_all};
use support::quantile;

/// Benchmark of the coordinator's cost per result: number of sessions, number of jobs, and bytes per result
/// (about the size of a score).
const BENCH_PLAN: (usize, u64, u32) = (16, 4000, 300);
/// Minimum number of evaluations per slot in a search on sleeping sessions (workers that sleep instead of
/// simulating).
const MIN_EVALUATIONS_PER_SLOT: u64 = 8;
/// Maximum number of warm-up rounds before all workers must have joined.
const MAX_WARM_UP_ROUNDS: u32 = 200;

/// Settings of a scaling measurement that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ScalingSettings {
    /// Names of the search presets to measure.
    pub(crate) presets: Vec<String>,
    /// Population sizes to measure (individuals per generation).
    pub(crate) populations: Vec<u64>,
    /// Evaluations per search on workers of this machine; also the minimum for a search on sleeping sessions.
    pub(crate) evaluations: u64,
    /// Numbers of simulating worker processes to measure.
    pub(crate) crews: Vec<u64>,
    /// Numbers of sleeping sessions (workers that sleep instead of simulating) to measure.
    pub(crate) sleeping: Vec<u64>,
    /// Mean sleeping time per job \[s\].
    pub(crate) sleep_s: f64,
    /// Numbers of worker slots to which the measured scaling is projected.
    pub(crate) projected: Vec<u64>,
}

impl RunIdentity for ScalingSettings {
    const KIND: &'static str = "sweep scaling";

    fn arguments(&self) -> String {
        let list = |name: &str, all: &[u64]| {
            let all: Vec<String> = all.iter().map(u64::to_string).collect();
            let all = if all.is_empty() {
                "0".to_owned()
            } else {
                all.join(",")
            };
            format!(" --{name} {all}")
        };
        [
            format!(" --presets {}", self.presets.join(",")),
            list("populations", &self.populations),
            format!(" --evaluations {}", self.evaluations),
            list("crews", &self.crews),
            list("sleeping", &self.sleeping),
            format!(" --sleep {}", self.sleep_s),
            list("projected", &self.projected),
        ]
        .concat()
    }
}

/// Row of the scaling table with the simulation times that were measured for it.
#[derive(Serialize, Deserialize)]
struct Measured {
    row: ScalingRow,
    /// Mean computing time of a simulation \[s\].
    simulation_s: f64,
    /// Quantiles of the computing time of a simulation at 0, 5 .. 100 % \[s\].
    simulation_quantiles_s: Vec<f64>,
}

impl ScalingSettings {
    /// Returns the settings of the search with preset `name` and size `population`, for the given number of
    /// worker slots.
    ///
    /// # Errors
    /// If the preset has no population setting, or the population is not allowed.
    pub(crate) fn settings(
        (name, population): (&str, u64),
        space: &Space,
        slots: u64,
    ) -> anyhow::Result<Settings> {
        let preset = preset(name).context("the catalogue has lost a preset")?;
        let workers = usize::try_from(slots)?;
        let mut chosen = (preset.settings)(&SearchPlan { space, workers });
        let set = preset.set(&mut chosen, "population", &population.to_string());
        set.map_err(|error| settings::refuse(preset, error))?;
        Ok(chosen)
    }

    /// Returns every combination of preset and population size to measure.
    pub(crate) fn searches(&self) -> impl Iterator<Item = (&str, u64)> {
        let each = self.presets.iter();
        each.flat_map(|name| {
            self.populations
                .iter()
                .map(move |own| (name.as_str(), *own))
        })
    }
}

/// Measures every row of the scaling table that is not yet stored in the run folder.
///
/// # Errors
/// If the settings are invalid, if no worker remains, or the user stops; stored rows are kept.
pub(crate) async fn scale(
    run: &Run<ScalingSettings>,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<ScalingResult> {
    let (settings, space) = (&run.manifest.settings, run.manifest.space(&run.case)?);
    let mut scale = ScalingRun {
        run,
        space: &space,
        folder: &run.folder,
    };
    let mut rows = Vec::new();
    let mut alone: Option<Measured> = None;
    for search in settings.searches() {
        for slots in settings.crews.iter().copied() {
            let name = file(SlotMode::Computed, search, slots);
            let make = async |scale: &mut ScalingRun<'_>| {
                scale.measure_computing(search, slots, watch, stop).await
            };
            let measured = scale.load_or_compute(&name, make).await?;
            rows.push(measured.row.clone());
            if alone.as_ref().is_none_or(|least| slots < least.row.slots) {
                alone = Some(measured);
            }
        }
    }
    let alone =
        alone.context("no number of worker processes was given: name at least one with --crews")?;
    let make = async |scale: &mut ScalingRun<'_>| scale.overheads(&alone).await;
    let overheads = scale.load_or_compute("overheads.json", make).await?;
    for search in settings.searches() {
        for slots in settings.sleeping.iter().copied() {
            let make = async |scale: &mut ScalingRun<'_>| {
                scale.measure_sleeping(search, slots, &overheads).await
            };
            rows.push(
                scale
                    .load_or_compute(&file(SlotMode::Slept, search, slots), make)
                    .await?,
            );
        }
        for slots in settings.projected.iter().copied() {
            let make = async |scale: &mut ScalingRun<'_>| {
                let strategy = scale.strategy(search, slots)?;
                Ok(project(search, strategy, scale.space, slots, &overheads))
            };
            rows.push(
                scale
                    .load_or_compute(&file(SlotMode::Projected, search, slots), make)
                    .await?,
            );
        }
    }
    Ok(ScalingResult::new(overheads, rows))
}

/// Returns the name of the file that stores a row of the scaling table; without its extension it is the name
/// of the row's journal folder.
fn file(how: SlotMode, (preset, population): (&str, u64), slots: u64) -> String {
    format!("{}-{preset}-{population}-{slots}.json", how.as_str())
}

struct ScalingRun<'a> {
    run: &'a Run<ScalingSettings>,
    space: &'a Space,
    folder: &'a RunFolder,
}

impl ScalingRun<'_> {
    /// Returns a measurement stored in the run folder under `name`, or makes and stores it. Wall times must
    /// be measured without interruption: an incomplete measurement is repeated from its beginning.
    async fn load_or_compute<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        make: impl AsyncFnOnce(&mut Self) -> anyhow::Result<T>,
    ) -> anyhow::Result<T> {
        if self.folder.file(name).exists() {
            return self.folder.read_json(name);
        }
        terminal::tell(&format!("measuring {}", name.trim_end_matches(".json")));
        let made = make(self).await?;
        self.folder.write_json(name, &made)?;
        Ok(made)
    }

    fn strategy(&self, search: (&str, u64), slots: u64) -> anyhow::Result<Box<dyn Strategy>> {
        let settings = ScalingSettings::settings(search, self.space, slots)?;
        Ok(build(&settings, self.space, self.run.manifest.seed)?)
    }

    /// Measures a search of the case on `slots` simulating worker processes.
    async fn measure_computing(
        &self,
        search: (&str, u64),
        slots: u64,
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Measured> {
        let case = &self.run.case;
        let journal = self
            .folder
            .file(&file(SlotMode::Computed, search, slots))
            .with_extension("");
        if journal.exists() {
            fs::remove_dir_all(&journal).with_context(|| journal.display().to_string())?;
        }
        let count = usize::try_from(slots)?;
        let options = Options {
            run_dir: journal.clone(),
            network: RemoteAccess::default(),
            local_workers: count,
            pause_limit: runtime::PAUSE_LIMIT,
            kind: ScalingSettings::KIND.to_owned(),
            settings: String::new(),
        };
        let mut bus = Bus::open(options, case).await?;
        // starting programs and fetching the case is over before the clock starts
        for round in 0..MAX_WARM_UP_ROUNDS {
            let near = (0..2 * slots).map(|index| {
                let offset = 1e-6 * (f64::from(round) * 2.0 * slots as f64 + index as f64);
                self.space.values(&vec![offset; self.space.dimension()])
            });
            let near: Vec<_> = near.collect();
            score_all(&mut bus, case, &near, watch, stop).await?;
            if bus.workers_status().workers.len() >= count {
                break;
            }
        }
        let list = [Search {
            settings: ScalingSettings::settings(search, self.space, slots)?,
            seed: self.run.manifest.seed,
            evaluations: Some(self.run.manifest.settings.evaluations),
        }];
        let (before, begun, processor) =
            (bus.workers_status().spent, Instant::now(), processor_time());
        let mut sweep = Sweep::new(case, self.space);
        let found = sweep.run(&mut bus, &list, watch, stop).await?;
        let (wall, after) = (begun.elapsed(), bus.workers_status().spent);
        let processor = processor_time().saturating_sub(processor);
        bus.close().await?;
        let evaluations = found.first().map_or(0, |found| found.evaluations);
        let (_, costs) = account::read_with_costs(&journal.join(journal::FILE))?;
        let mut times: Vec<f64> = costs.values().map(|cost| cost.wall_s).collect();
        times.sort_by(f64::total_cmp);
        let quantiles = (0..=100)
            .step_by(5)
            .filter_map(|at| quantile::of(&times, at));
        Ok(Measured {
            row: row(
                (SlotMode::Computed, search, slots),
                evaluations,
                (wall, processor),
                [before, after],
            ),
            simulation_s: times.iter().sum::<f64>() / times.len().max(1) as f64,
            simulation_quantiles_s: quantiles.collect(),
        })
    }

    /// Measures the coordinator's cost per empty job and the round-trip time of a job, and combines them with
    /// the simulation times of `alone`, the measurement with the fewest slots.
    async fn overheads(&self, alone: &Measured) -> anyhow::Result<Overheads> {
        let (workers, jobs, result_bytes) = BENCH_PLAN;
        let plan = BenchPlan {
            by: BenchWorkers::Connections,
            workers,
            jobs,
            result_bytes,
            silent: None,
        };
        let scratch = tempfile::tempdir()?;
        let options = empty_run(scratch.path())?;
        let result = runtime::bench(options, plan).await;
        let result = result.map_err(|error| bus::explain(&error))?;
        Ok(Overheads {
            simulation_s: alone.simulation_s,
            simulation_quantiles_s: alone.simulation_quantiles_s.clone(),
            coordinator_us: result.coordinator_cpu_us_per_job,
            round_trip_ms: result.rtt_median_ms,
        })
    }

    /// Measures a search on `slots` sessions whose workers sleep for times distributed like the simulation
    /// times.
    async fn measure_sleeping(
        &self,
        search: (&str, u64),
        slots: u64,
        overheads: &Overheads,
    ) -> anyhow::Result<ScalingRow> {
        let ScalingSettings {
            evaluations,
            sleep_s,
            ..
        } = self.run.manifest.settings;
        let takes = |id: u64| {
            let uneven = overheads.sample_duration_s(id) / overheads.simulation_s;
            Duration::try_from_secs_f64(sleep_s * uneven).unwrap_or_default()
        };
        let stand = SyntheticObjective(self.space);
        let tell = |genes: &[f64]| stand.evaluate(genes);
        let mut source = JobSource::new(self.strategy(search, slots)?, &tell);
        source.limit = evaluations.max(MIN_EVALUATIONS_PER_SLOT * slots);
        let scratch = tempfile::tempdir()?;
        let options = empty_run(scratch.path())?;
        let slept = sleep_through(options, usize::try_from(slots)?, &mut source, &takes).await;
        let slept = slept.map_err(|error| bus::explain(&error))?;
        if slept.slots < usize::try_from(slots)? {
            return Err(Problem {
                message: format!("only {} of {slots} sessions joined", slept.slots),
                remedy: "give smaller numbers with --sleeping, or raise the limit of open connections that `ulimit -n` shows"
                    .to_owned(),
            }
            .into());
        }
        let evaluated = source.strategy.archive().entries().len() as u64;
        let times = (slept.wall, slept.processor);
        Ok(row(
            (SlotMode::Slept, search, slots),
            evaluated,
            times,
            slept.spent,
        ))
    }
}

/// Returns the dispatcher options of a run of empty jobs in a temporary folder.
fn empty_run(folder: &std::path::Path) -> anyhow::Result<runtime::DispatchOptions> {
    let options = Options {
        run_dir: folder.to_owned(),
        network: RemoteAccess::default(),
        local_workers: 0,
        pause_limit: runtime::PAUSE_LIMIT,
        kind: "bench".to_owned(),
        settings: "{}".to_owned(),
    };
    options.for_dispatch(&Case::default())
}

/// Builds a row of the scaling table from measured values; `(wall, processor)` are the wall time and the
/// coordinator's processor time of the search.
fn row(
    (how, (preset, population), slots): (SlotMode, (&str, u64), u64),
    evaluations: u64,
    (wall, processor): (Duration, Duration),
    [before, after]: [Spent; 2],
) -> ScalingRow {
    ScalingRow {
        how,
        preset: preset.to_owned(),
        population,
        slots,
        evaluations,
        wall_s: wall.as_secs_f64(),
        useful_s: after.useful_us.saturating_sub(before.useful_us) as f64 / 1e6,
        shares: Shares::between(&before, &after),
        coordinator_us_per_result: processor.as_secs_f64() * 1e6 / evaluations.max(1) as f64,
        coordinator_share: processor.as_secs_f64() / wall.as_secs_f64(),
        speed_up: 0.0,
        efficiency: 0.0,
    }
}
