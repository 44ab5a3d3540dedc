//! Scaling measurement over numbers of slots: rows are measured one after another, and each is stored in the
//! run folder as soon as it is complete.
use super::{
    begun::Run,
    bus::{self, Bus, Options},
    folder::RunFolder,
    manifest::Decides,
};
use crate::cli::{
    argument::{door::Door, settings},
    output::{problem::Problem, terminal},
};
use anyhow::Context as _;
use dispatch::account;
use dispatch::journal;
use dispatch::runtime::{self, BenchPlan, BenchWorkers, processor_time, sleep_through};
use dispatch::simulated::Search as Source;
use protocol::{case::Case, event::Spent};
use search::{
    space::Space,
    strategy::{Plan, Settings, Strategy, build, preset},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs,
    time::{Duration, Instant},
};
use study::scaling::{How, Overheads, Row, Scaled, Shares, Stand, project};
use study::{Evaluator as _, ProgressView, Search, Stop, Sweep, Watch, score_all};
use support::quantile;

/// Benchmark of the coordinator's cost per result: number of sessions, number of jobs, and bytes per result
/// (about the size of a score).
const MEASURED: (usize, u64, u32) = (16, 4000, 300);
/// Minimum number of evaluations per slot in a search on sleeping sessions.
const EACH: u64 = 8;
/// Maximum number of warm-up rounds before all workers must have joined.
const WARMING: u32 = 200;

/// Settings of a scaling measurement that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Scaling {
    /// Names of the search presets to measure.
    pub(crate) presets: Vec<String>,
    /// Population sizes to measure (individuals per generation).
    pub(crate) populations: Vec<u64>,
    /// Evaluations per search on workers of this machine; minimum for a search on sleeping sessions.
    pub(crate) evaluations: u64,
    /// Numbers of simulating worker processes to measure.
    pub(crate) crews: Vec<u64>,
    /// Numbers of sleeping sessions to measure.
    pub(crate) sleeping: Vec<u64>,
    /// Mean sleeping time per job \[s\].
    pub(crate) sleep_s: f64,
    /// Numbers of slots to project to.
    pub(crate) projected: Vec<u64>,
}

impl Decides for Scaling {
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
    row: Row,
    /// Mean computing time of a simulation \[s\].
    simulation_s: f64,
    /// Quantiles of the computing time of a simulation at 0, 5 .. 100 % \[s\].
    simulation_quantiles_s: Vec<f64>,
}

impl Scaling {
    /// Returns the settings of a search for the given number of slots.
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
        let mut chosen = (preset.settings)(&Plan { space, workers });
        let set = preset.set(&mut chosen, "population", &population.to_string());
        set.map_err(|error| settings::refuse(preset, error))?;
        Ok(chosen)
    }

    /// Returns every combination of preset and population size.
    pub(crate) fn searches(&self) -> impl Iterator<Item = (&str, u64)> {
        let each = self.presets.iter();
        each.flat_map(|name| {
            self.populations
                .iter()
                .map(move |own| (name.as_str(), *own))
        })
    }
}

/// Measures every row that is not yet stored in the run folder.
///
/// # Errors
/// If the settings are invalid, if no worker remains, or the user stops; stored rows are kept.
pub(crate) async fn scale(
    run: &Run<Scaling>,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<Scaled> {
    let (settings, space) = (&run.manifest.settings, run.manifest.space(&run.case)?);
    let mut scale = Scale {
        run,
        space: &space,
        folder: &run.folder,
    };
    let mut rows = Vec::new();
    let mut alone: Option<Measured> = None;
    for search in settings.searches() {
        for slots in settings.crews.iter().copied() {
            let name = file(How::Computed, search, slots);
            let make =
                async |scale: &mut Scale<'_>| scale.compute(search, slots, watch, stop).await;
            let measured = scale.kept(&name, make).await?;
            rows.push(measured.row.clone());
            if alone.as_ref().is_none_or(|least| slots < least.row.slots) {
                alone = Some(measured);
            }
        }
    }
    let alone =
        alone.context("no number of worker processes was given: name at least one with --crews")?;
    let make = async |scale: &mut Scale<'_>| scale.overheads(&alone).await;
    let overheads = scale.kept("overheads.json", make).await?;
    for search in settings.searches() {
        for slots in settings.sleeping.iter().copied() {
            let make = async |scale: &mut Scale<'_>| scale.sleep(search, slots, &overheads).await;
            rows.push(scale.kept(&file(How::Slept, search, slots), make).await?);
        }
        for slots in settings.projected.iter().copied() {
            let make = async |scale: &mut Scale<'_>| {
                let strategy = scale.strategy(search, slots)?;
                Ok(project(search, strategy, scale.space, slots, &overheads))
            };
            rows.push(
                scale
                    .kept(&file(How::Projected, search, slots), make)
                    .await?,
            );
        }
    }
    Ok(Scaled::new(overheads, rows))
}

/// Returns the file name of a row; without its extension, the name of its journal folder.
fn file(how: How, (preset, population): (&str, u64), slots: u64) -> String {
    format!("{}-{preset}-{population}-{slots}.json", how.as_str())
}

/// Scaling measurement in progress.
struct Scale<'a> {
    run: &'a Run<Scaling>,
    space: &'a Space,
    folder: &'a RunFolder,
}

impl Scale<'_> {
    /// Returns the content of a file, or computes and stores it. Wall times must be measured without
    /// interruption: an incomplete row is measured again from its beginning.
    async fn kept<T: Serialize + DeserializeOwned>(
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
        let settings = Scaling::settings(search, self.space, slots)?;
        Ok(build(&settings, self.space, self.run.manifest.seed)?)
    }

    /// Measures a search of the case on `slots` worker processes.
    async fn compute(
        &self,
        search: (&str, u64),
        slots: u64,
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Measured> {
        let case = &self.run.case;
        let journal = self
            .folder
            .file(&file(How::Computed, search, slots))
            .with_extension("");
        if journal.exists() {
            fs::remove_dir_all(&journal).with_context(|| journal.display().to_string())?;
        }
        let count = usize::try_from(slots)?;
        let options = Options {
            run_dir: journal.clone(),
            door: Door::default(),
            local_workers: count,
            pause_limit: runtime::PAUSE_LIMIT,
            kind: Scaling::KIND.to_owned(),
            settings: String::new(),
        };
        let mut bus = Bus::open(options, case).await?;
        // starting programs and fetching the case is over before the clock starts
        for round in 0..WARMING {
            let near = (0..2 * slots).map(|index| {
                let offset = 1e-6 * (f64::from(round) * 2.0 * slots as f64 + index as f64);
                self.space.values(&vec![offset; self.space.dimension()])
            });
            let near: Vec<_> = near.collect();
            score_all(&mut bus, case, &near, watch, stop).await?;
            if bus.crew().workers.len() >= count {
                break;
            }
        }
        let list = [Search {
            settings: Scaling::settings(search, self.space, slots)?,
            seed: self.run.manifest.seed,
            evaluations: Some(self.run.manifest.settings.evaluations),
        }];
        let (before, begun, processor) = (bus.crew().spent, Instant::now(), processor_time());
        let mut sweep = Sweep::new(case, self.space);
        let found = sweep.run(&mut bus, &list, watch, stop).await?;
        let (wall, after) = (begun.elapsed(), bus.crew().spent);
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
                (How::Computed, search, slots),
                evaluations,
                (wall, processor),
                [before, after],
            ),
            simulation_s: times.iter().sum::<f64>() / times.len().max(1) as f64,
            simulation_quantiles_s: quantiles.collect(),
        })
    }

    /// Measures the coordinator's cost per empty job and the round-trip time, and adds the simulation times
    /// of `alone`.
    async fn overheads(&self, alone: &Measured) -> anyhow::Result<Overheads> {
        let (workers, jobs, result_bytes) = MEASURED;
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

    /// Measures a search on `slots` sessions that sleep for times distributed like the simulation times.
    async fn sleep(
        &self,
        search: (&str, u64),
        slots: u64,
        overheads: &Overheads,
    ) -> anyhow::Result<Row> {
        let Scaling {
            evaluations,
            sleep_s,
            ..
        } = self.run.manifest.settings;
        let takes = |id: u64| {
            let uneven = overheads.takes_s(id) / overheads.simulation_s;
            Duration::try_from_secs_f64(sleep_s * uneven).unwrap_or_default()
        };
        let stand = Stand(self.space);
        let tell = |genes: &[f64]| stand.tell(genes);
        let mut source = Source::new(self.strategy(search, slots)?, &tell);
        source.limit = evaluations.max(EACH * slots);
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
            (How::Slept, search, slots),
            evaluated,
            times,
            slept.spent,
        ))
    }
}

/// Returns the options of a run of empty jobs in a temporary folder.
fn empty_run(folder: &std::path::Path) -> anyhow::Result<runtime::DispatchOptions> {
    let options = Options {
        run_dir: folder.to_owned(),
        door: Door::default(),
        local_workers: 0,
        pause_limit: runtime::PAUSE_LIMIT,
        kind: "bench".to_owned(),
        settings: "{}".to_owned(),
    };
    options.for_dispatch(&Case::default())
}

/// Builds a row from measured values; the two times are wall time and processor time of the coordinator.
fn row(
    (how, (preset, population), slots): (How, (&str, u64), u64),
    evaluations: u64,
    (wall, processor): (Duration, Duration),
    [before, after]: [Spent; 2],
) -> Row {
    Row {
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
