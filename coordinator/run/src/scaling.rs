//! Scaling measurement over numbers of worker slots: rows of the scaling table are measured one after
//! another, and each is stored in the run folder as soon as it is complete.
use crate::{manifest::RunIdentity, message, opened::Run, session::dispatcher, settings};
use anyhow::Context as _;
use dispatch::{bench::processor_time, runtime::DispatchOptions};
use journal::account;
use journal::event::JobReason;
use journal::job_range::DERIVATIVE_COSTS;
use protocol::{
    id::JobId,
    job::{Column, Individual, Job, Reply, SimulateSpec},
};
use search::{
    space::Space,
    strategy::{SearchPlan, Settings, preset},
};
use serde::{Deserialize, Serialize};
use std::{fs, time::Instant};
use study::scaling::{ScalingRow, Shares, SlotMode};
use study::{Evaluator, EvaluatorError, ProgressView, Search, Stop, Sweep, Watch, score_all};
use support::quantile;

/// Maximum number of warm-up rounds before all workers must have joined.
const MAX_WARM_UP_ROUNDS: u32 = 200;
/// Minimum number of simulations of each kind from which the cost of derivatives is measured.
const DERIVATIVE_SAMPLES: u64 = 3;

/// Search to measure: the name of a preset, and the number of individuals per generation if that is chosen.
pub type Searched<'a> = (&'a str, Option<u64>);

/// Settings of a scaling measurement that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScalingSettings {
    /// Names of the search presets to measure.
    pub presets: Vec<String>,
    /// Population sizes to measure (individuals per generation); each preset's own if empty.
    pub populations: Vec<u64>,
    /// Evaluations per search.
    pub evaluations: u64,
    /// Numbers of simulating worker processes to measure.
    pub crews: Vec<u64>,
    /// Numbers of remote workers to measure.
    pub nodes: Vec<u64>,
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
        let some = |name: &str, all: &[u64]| {
            if all.is_empty() {
                String::new()
            } else {
                list(name, all)
            }
        };
        [
            format!(" --presets {}", self.presets.join(",")),
            some("populations", &self.populations),
            format!(" --evaluations {}", self.evaluations),
            list("crews", &self.crews),
            some("nodes", &self.nodes),
        ]
        .concat()
    }
}

impl ScalingSettings {
    /// Returns the settings of a search for the given number of worker slots.
    ///
    /// # Errors
    /// If the population is not allowed.
    pub fn settings(
        (name, population): Searched<'_>,
        space: &Space,
        slots: u64,
    ) -> anyhow::Result<Settings> {
        let preset = preset(name).context("the catalogue has lost a preset")?;
        let workers = usize::try_from(slots)?;
        let mut chosen = (preset.settings)(&SearchPlan { space, workers });
        if let Some(population) = population {
            let set = preset.set(&mut chosen, "population", &population.to_string());
            set.map_err(|error| settings::refuse(preset, &error))?;
        }
        Ok(chosen)
    }

    /// Returns every combination of preset and population size to measure; a preset without population is
    /// measured once.
    pub fn searches(&self) -> Vec<Searched<'_>> {
        let sizes = |name: &str| -> Vec<Option<u64>> {
            let settable = preset(name).map(search::strategy::Preset::settable);
            let mut settable = settable.into_iter().flatten();
            if self.populations.is_empty() || !settable.any(|one| one.key == "population") {
                return vec![None];
            }
            self.populations.iter().copied().map(Some).collect()
        };
        let each = self.presets.iter().map(String::as_str);
        each.flat_map(|name| sizes(name).into_iter().map(move |size| (name, size)))
            .collect()
    }
}

/// Returns the name of the file that stores a row of the scaling table; without its extension it is the name
/// of the row's journal folder.
pub(crate) fn file(how: SlotMode, (preset, population): Searched<'_>, slots: u64) -> String {
    let population = population.map_or_else(String::new, |size| format!("-{size}"));
    format!("{}-{preset}{population}-{slots}.json", how.as_str())
}

/// Scaling measurement of a run.
pub struct ScalingRun<'a> {
    pub(crate) run: &'a Run<ScalingSettings>,
    space: &'a Space,
}

impl<'a> ScalingRun<'a> {
    /// Creates the measurement of a run, whose case is searched in `space`.
    pub const fn new(run: &'a Run<ScalingSettings>, space: &'a Space) -> Self {
        Self { run, space }
    }
}

impl ScalingRun<'_> {
    /// Measures every search on the workers of this machine, as far as its rows are not stored in the run folder.
    ///
    /// # Errors
    /// If the settings are invalid, if no worker remains, or the user stops; stored rows are kept.
    pub async fn measure_local(
        &mut self,
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Vec<ScalingRow>> {
        let settings = &self.run.manifest.settings;
        let mut measured = Vec::new();
        for search in settings.searches() {
            for slots in settings.crews.iter().copied() {
                let name = file(SlotMode::Computed, search, slots);
                let make = async |scale: &mut Self| {
                    scale.measure_computing(search, slots, watch, stop).await
                };
                measured.push(self.load_or_compute(&name, make).await?);
            }
        }
        Ok(measured)
    }

    /// Returns a measurement stored in the run folder under `name`, or makes and stores it. Wall times must
    /// be measured without interruption: an incomplete measurement is repeated from its beginning.
    pub(crate) async fn load_or_compute(
        &mut self,
        name: &str,
        make: impl AsyncFnOnce(&mut Self) -> anyhow::Result<ScalingRow>,
    ) -> anyhow::Result<ScalingRow> {
        // a row of another version, or one that is damaged, is measured again
        let stored = fs::read(self.run.folder.file(name)).unwrap_or_default();
        if let Ok(row) = serde_json::from_slice(&stored) {
            return Ok(row);
        }
        message::print(&format!("measuring {}", name.trim_end_matches(".json")));
        let made = make(self).await?;
        self.run.folder.write_json(name, &made)?;
        Ok(made)
    }

    /// Measures a search of the case on `slots` simulating worker processes.
    async fn measure_computing(
        &self,
        search: Searched<'_>,
        slots: u64,
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<ScalingRow> {
        let case = &self.run.case;
        let journal = self
            .run
            .folder
            .file(&file(SlotMode::Computed, search, slots))
            .with_extension("");
        if journal.exists() {
            fs::remove_dir_all(&journal).with_context(|| journal.display().to_string())?;
        }
        let count = usize::try_from(slots)?;
        let kind = ScalingSettings::KIND;
        let options = DispatchOptions::local(&journal, count, case, kind, String::new())?;
        let mut dispatch = dispatcher::open(options).await?;
        for round in 0..MAX_WARM_UP_ROUNDS {
            self.warm_up(&mut dispatch, (round, slots), watch, stop)
                .await?;
            if dispatch.snapshot().workers.len() >= count {
                break;
            }
        }
        let derivatives_over_plain = self.derivatives_over_plain(&mut dispatch, slots).await?;
        let row = self
            .time_search(
                &mut dispatch,
                (SlotMode::Computed, search, slots),
                watch,
                stop,
            )
            .await?;
        dispatch.close().await.map_err(EvaluatorError::from)?;
        let (_, costs) = account::read_with_costs(&journal.join(journal::FILE))?;
        let times = costs.values().map(|cost| cost.wall_s).collect();
        Ok(with_times(row, times, derivatives_over_plain))
    }

    /// Evaluates two individuals for each slot near the start, so that starting programs and fetching the case
    /// is over before the clock starts; each round has other individuals.
    pub(crate) async fn warm_up<E: Evaluator>(
        &self,
        evaluator: &mut E,
        (round, slots): (u32, u64),
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<()> {
        let near = (0..2 * slots).map(|index| self.near(u64::from(round) * 2 * slots + index));
        let near: Vec<_> = near.collect();
        score_all(evaluator, &self.run.case, &near, watch, stop).await?;
        Ok(())
    }

    /// Returns the `index`-th of a series of individuals close to the start.
    fn near(&self, index: u64) -> Vec<f64> {
        // never the start itself, which the measured searches evaluate: jobs are numbered by their content
        let offset = 1e-6 * (index + 1) as f64;
        self.space.values(&vec![offset; self.space.dimension()])
    }

    /// Measures the computing time of a simulation with the derivatives by all unknowns, over that of a plain
    /// one. There are as many jobs as slots, so that none is divided.
    pub(crate) async fn derivatives_over_plain<E: Evaluator>(
        &self,
        evaluator: &mut E,
        slots: u64,
    ) -> anyhow::Result<f64> {
        let case = &self.run.case;
        let moving = case.unknowns.iter().filter(|it| !it.fixed && !it.is_off());
        let columns: Vec<Column> = moving.map(|it| Column::new(it.name.clone())).collect();
        let count = slots.max(DERIVATIVE_SAMPLES);
        let mut times = [0.0; 2];
        for (kind, columns) in [Vec::new(), columns].into_iter().enumerate() {
            for index in 0..count {
                let individual = Individual::new(case.objective.condition, self.near(index));
                let reply = Reply::Score {
                    with_residual: true,
                    whole: true,
                };
                let job = Job::Simulate(SimulateSpec {
                    columns: columns.clone(),
                    ..SimulateSpec::new(individual, reply)
                });
                let id = DERIVATIVE_COSTS + kind as u64 * count + index;
                evaluator.submit(JobId(id), job, JobReason::outside_search("derivatives"))?;
            }
            for _ in 0..count {
                times[kind] += evaluator.next().await?.cost.wall_s();
            }
        }
        let [plain, derived] = times;
        Ok(if plain > 0.0 {
            (derived / plain).max(1.0)
        } else {
            1.0
        })
    }

    /// Runs a search on an evaluator and returns its row of the scaling table.
    pub(crate) async fn time_search<E: Evaluator>(
        &self,
        evaluator: &mut E,
        (how, search, slots): (SlotMode, Searched<'_>, u64),
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<ScalingRow> {
        let list = [Search {
            settings: ScalingSettings::settings(search, self.space, slots)?,
            seed: self.run.manifest.seed,
            evaluations: Some(self.run.manifest.settings.evaluations),
        }];
        let before = evaluator.current_snapshot().await?.spent;
        let (begun, processor) = (Instant::now(), processor_time());
        let mut sweep = Sweep::new(&self.run.case, self.space);
        let found = sweep.run(evaluator, &list, watch, stop).await?;
        let wall = begun.elapsed();
        let processor = processor_time().saturating_sub(processor);
        let after = evaluator.current_snapshot().await?.spent;
        let evaluations = found.first().map_or(0, |found| found.evaluations);
        let (preset, population) = search;
        Ok(ScalingRow {
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
            simulation_s: f64::NAN,
            simulation_quantiles_s: Vec::new(),
            derivatives_over_plain: f64::NAN,
        })
    }
}

/// Completes a row with the computing times of its simulations \[s\], in any order, and with the cost of derivatives.
pub(crate) fn with_times(
    row: ScalingRow,
    mut times: Vec<f64>,
    derivatives_over_plain: f64,
) -> ScalingRow {
    times.sort_by(f64::total_cmp);
    let quantiles = (0..=100)
        .step_by(5)
        .filter_map(|at| quantile::of(&times, at));
    ScalingRow {
        simulation_s: times.iter().sum::<f64>() / times.len().max(1) as f64,
        simulation_quantiles_s: quantiles.collect(),
        derivatives_over_plain,
        ..row
    }
}
